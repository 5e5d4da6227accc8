"""The elimination tree of a symmetric pattern, and the supernodes of its factor.

Patterns are compressed columns of the whole matrix with sorted rows, in the order of elimination.
"""

import numpy as np
from numba import njit

# Columns of a panel at most: beyond, its triangle is mostly zeros.
WIDEST = 64
# Share of zeros with which supernodes are joined.
ZEROS = 0.1


@njit(cache=True)
def elimination_tree(indptr, indices):
    """Parent of every column, -1 of roots; J. W. H. Liu, ACM Transactions on Mathematical Software 12 (1986) 127."""
    n = len(indptr) - 1
    parent, ancestor = np.full(n, -1), np.full(n, -1)
    for j in range(n):
        for p in range(indptr[j], indptr[j + 1]):
            i = np.int64(indices[p])
            while i < j and ancestor[i] != j:
                above, ancestor[i] = ancestor[i], j
                if above == -1:
                    parent[i] = j
                    break
                i = above
    return parent


@njit(cache=True)
def postorder(parent):
    """Places of columns in an order in which every column follows right behind its descendants."""
    n = len(parent)
    head, following, places = np.full(n + 1, -1), np.full(n, -1), np.empty(n, dtype=np.int64)
    for j in range(n - 1, -1, -1):
        # roots hang on the last entry
        following[j], head[parent[j]] = head[parent[j]], j
    placed, at = 0, head[n]
    while at != -1:
        while head[at] != -1:
            at = head[at]
        places[at] = placed
        placed += 1
        while at != -1 and following[at] == -1:
            at = parent[at]
            if at != -1:
                places[at] = placed
                placed += 1
        if at != -1:
            at = following[at]
    return places


@njit(cache=True)
def count_columns(parent, indptr, indices):
    """Entries of every column of the factor: row i has those on the ways up the tree from its entries to i."""
    n = len(parent)
    count, seen = np.ones(n, dtype=np.int64), np.full(n, -1)
    for i in range(n):
        seen[i] = i
        for p in range(indptr[i], indptr[i + 1]):
            k = np.int64(indices[p])
            while k < i and seen[k] != i:
                seen[k] = i
                count[k] += 1
                k = parent[k]
    return count


@njit(cache=True)
def find_supernodes(parent, count):
    """First columns of the supernodes and n, and how many rows each has below."""
    n = len(parent)
    starts, below, zeros = [0], [count[0] - 1], [0]
    for j in range(1, n + 1):
        exact = j < n and parent[j - 1] == j and count[j - 1] == count[j] + 1
        if exact and j - starts[-1] < WIDEST:
            below[-1] = count[j] - 1
            continue
        # the supernode is complete: the one before joins it where that costs few zeros
        while len(starts) > 1 and starts[-2] <= parent[starts[-1] - 1] < j and parent[starts[-1] - 1] >= starts[-1]:
            width, more = starts[-1] - starts[-2], j - starts[-1]
            added = zeros[-2] + zeros[-1] + width * (more + below[-1] - below[-2])
            whole = (width + more) * (0.5 * (width + more) + below[-1])
            if width + more > WIDEST or added > ZEROS * whole:
                break
            zeros[-2], below[-2] = added, below[-1]
            starts.pop(), below.pop(), zeros.pop()
        if j < n:
            starts.append(j)
            below.append(count[j] - 1)
            zeros.append(0)
    starts.append(n)
    return np.array(starts), np.array(below)


@njit(cache=True)
def fill_rows(starts, firsts, indptr, indices, rows_out):
    """Rows below the supernodes in any order: the matrix's, and those below the supernodes that go into one."""
    supernodes, n = len(starts) - 1, starts[-1]
    owner, seen = np.empty(n, dtype=np.int64), np.full(n, -1)
    head, following = np.full(supernodes, -1), np.full(supernodes, -1)
    for s in range(supernodes):
        owner[starts[s] : starts[s + 1]] = s
    for s in range(supernodes):
        end, at, first = starts[s + 1], firsts[s], n
        for p in range(indptr[starts[s]], indptr[end]):
            if indices[p] >= end and seen[indices[p]] != s:
                seen[indices[p]] = s
                rows_out[at] = indices[p]
                first = min(first, indices[p])
                at += 1
        child = head[s]
        while child != -1:
            for p in range(firsts[child], firsts[child + 1]):
                if rows_out[p] >= end and seen[rows_out[p]] != s:
                    seen[rows_out[p]] = s
                    rows_out[at] = rows_out[p]
                    first = min(first, rows_out[p])
                    at += 1
            child = following[child]
        if first < n:
            following[s], head[owner[first]] = head[owner[first]], s
