"""Everything that touches Exudyn: the film element, kinematics of markers, histories, sensors."""
