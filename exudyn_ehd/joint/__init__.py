"""One lubricated joint as a pure function of its motion: film (and bush) behind one evaluation; no Exudyn."""
