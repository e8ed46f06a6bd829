"""Linear systems in the velocities of bodies that touch: sparse, in blocks of six, eliminated body by body."""

from typing import NamedTuple

import numpy as np

from blockshake.jit import inner_kernel, kernel_without_aliasing, kernel_without_allocation

_FREE = 6  # velocities of a body


class BlockSystem(NamedTuple):
    """Matrix and right side of a system whose unknowns are the velocities of the free bodies.

    Rows and columns stand in the order of elimination. ``rank`` int64 (n_bodies,): place of each body in it, -1 for
    driven ones. ``first`` int64 (n_free + 1,) and ``column`` int64 (n_blocks,): the blocks right of the diagonal in
    row k are those of columns ``column[first[k]:first[k + 1]]``, increasing, with room for what elimination fills
    in. ``diagonal`` (n_free, 6, 6); ``right_of`` and ``below`` (n_blocks, 6, 6): block (k, j), and
    block (j, k) transposed. ``x`` (n_free, 6): right side, and then the answer. ``exchange`` int64 (n_free, 6): rows
    that elimination exchanged.
    """

    rank: np.ndarray
    first: np.ndarray
    column: np.ndarray
    diagonal: np.ndarray
    right_of: np.ndarray
    below: np.ndarray
    x: np.ndarray
    exchange: np.ndarray


@inner_kernel
def block_system(driven, body_a, body_b):
    """`BlockSystem` of bodies joined in pairs, its numbers not filled in.

    ``driven`` bool (n_bodies,); ``body_a``, ``body_b`` int64 (n_contacts,).

    Notes
    -----
    Minimum degree (Tinney and Walker 1967): the body with fewest neighbours left goes first, of
    several the first in the order of the bodies, and its neighbours become neighbours of each other.
    """
    body_of, number = np.empty(driven.size, np.int64), np.full(driven.size, -1, np.int64)
    n = 0
    for body in range(driven.size):
        if not driven[body]:
            number[body] = n
            body_of[n] = body
            n += 1
    touch, degree = np.zeros((n, n), np.bool_), np.zeros(n, np.int64)
    for contact in range(body_a.size):
        i, j = number[body_a[contact]], number[body_b[contact]]
        if i >= 0 and j >= 0 and not touch[i, j]:
            touch[i, j] = touch[j, i] = True
            degree[i] += 1
            degree[j] += 1
    rank, position = np.full(driven.size, -1, np.int64), np.full(n, -1, np.int64)
    first, column, count = np.zeros(n + 1, np.int64), np.empty(4 * n + 4, np.int64), 0
    # symbolic elimination: the pattern of the factors is known before any number is
    for k in range(n):
        least = -1
        for i in range(n):
            if position[i] < 0 and (least < 0 or degree[i] < degree[least]):
                least = i
        position[least] = k
        rank[body_of[least]] = k
        if count + n > column.size:
            column = np.concatenate((column, np.empty(column.size + n, np.int64)))
        for i in range(n):
            if position[i] < 0 and touch[least, i]:
                column[count] = i
                count += 1
        first[k + 1] = count
        # eliminating a body couples all of its neighbours: the fill-in
        for entry in range(first[k], count):
            i = column[entry]
            degree[i] -= 1
            for other in range(entry + 1, count):
                j = column[other]
                if not touch[i, j]:
                    touch[i, j] = touch[j, i] = True
                    degree[i] += 1
                    degree[j] += 1
    # columns by place in the elimination instead of by body, increasing in every row
    for k in range(n):
        for entry in range(first[k], first[k + 1]):
            # insertion: rows are short
            here, at = position[column[entry]], entry
            while at > first[k] and column[at - 1] > here:
                column[at] = column[at - 1]
                at -= 1
            column[at] = here
    return BlockSystem(
        rank, first, column[:count].copy(), np.empty((n, _FREE, _FREE)), np.empty((count, _FREE, _FREE)),
        np.empty((count, _FREE, _FREE)), np.empty((n, _FREE)), np.empty((n, _FREE), np.int64),
    )  # fmt: skip


@kernel_without_allocation
def find_block(system, row, column):
    """Entry of ``right_of`` and ``below`` that holds the block of a row and a later column."""
    low, high = system.first[row], system.first[row + 1]
    while high - low > 1:
        middle = (low + high) // 2
        if system.column[middle] <= column:
            low = middle
        else:
            high = middle
    return low


@kernel_without_allocation
def _factor_into(A, exchange):
    """Elimination within a block, rows exchanged; False where it is singular.

    ``exchange`` int64 (6,): row that took the place of each.
    """
    for k in range(_FREE):
        pivot = k
        for i in range(k + 1, _FREE):
            if abs(A[i, k]) > abs(A[pivot, k]):
                pivot = i
        exchange[k] = pivot
        if not abs(A[pivot, k]) > 0.0:
            return False
        if pivot != k:
            for j in range(_FREE):
                A[k, j], A[pivot, j] = A[pivot, j], A[k, j]
        for i in range(k + 1, _FREE):
            A[i, k] /= A[k, k]
            for j in range(k + 1, _FREE):
                A[i, j] -= A[i, k] * A[k, j]
    return True


@kernel_without_aliasing
def _divide_right_into(A, exchange, B):
    """The rows of ``B``, right of the factored block ``A``, once those of ``A`` are eliminated."""
    for k in range(_FREE):
        pivot = exchange[k]
        if pivot != k:
            for j in range(_FREE):
                B[k, j], B[pivot, j] = B[pivot, j], B[k, j]
    for k in range(1, _FREE):
        for i in range(k):
            factor = A[k, i]
            for j in range(_FREE):
                B[k, j] -= factor * B[i, j]


@kernel_without_aliasing
def _divide_below_into(A, B):
    """Multipliers, transposed, of the rows of ``B^T`` below the factored block ``A``."""
    for k in range(_FREE):
        for i in range(k):
            factor = A[i, k]
            for j in range(_FREE):
                B[k, j] -= factor * B[i, j]
        for j in range(_FREE):
            B[k, j] /= A[k, k]


@kernel_without_aliasing
def _subtract_into(A, B, C):
    """Subtract ``A^T B`` from ``C``."""
    for i in range(_FREE):
        for j in range(_FREE):
            C[i, j] -= (
                A[0, i] * B[0, j]
                + A[1, i] * B[1, j]
                + A[2, i] * B[2, j]
                + A[3, i] * B[3, j]
                + A[4, i] * B[4, j]
                + A[5, i] * B[5, j]
            )


@kernel_without_allocation
def solve_blocks_into(system):
    """Replace the right side ``x`` by the answer; the blocks are lost. False where a block is singular.

    Notes
    -----
    Elimination in blocks, with rows exchanged within a block and not beyond: the matrix is a positive definite one
    and a smaller unsymmetric part, of slipping contacts.
    """
    n = system.x.shape[0]
    for k in range(n):
        # A = P^T L U within the block: the row exchanges of the 6 x 6 factors stay inside
        A, exchange = system.diagonal[k], system.exchange[k]
        first, last = system.first[k], system.first[k + 1]
        if not _factor_into(A, exchange):
            return False
        y = system.x[k]
        for i in range(_FREE):
            pivot = exchange[i]
            y[i], y[pivot] = y[pivot], y[i]
            for j in range(i):
                y[i] -= A[i, j] * y[j]
        for entry in range(first, last):
            _divide_right_into(A, exchange, system.right_of[entry])
            _divide_below_into(A, system.below[entry])
        # Schur complement of block k: S_ij -= B_ki^T A^-1 C_kj for every pair of its neighbours i, j
        for entry in range(first, last):
            i = system.column[entry]
            right, below = system.right_of[entry], system.below[entry]
            _subtract_into(below, right, system.diagonal[i])
            for row in range(_FREE):
                for inner in range(_FREE):
                    system.x[i, row] -= below[inner, row] * y[inner]
            # both rows increase, so that one pass finds where block (i, j) is kept
            at = system.first[i]
            for other in range(entry + 1, last):
                while system.column[at] < system.column[other]:
                    at += 1
                _subtract_into(below, system.right_of[other], system.right_of[at])
                _subtract_into(right, system.below[other], system.below[at])
    # back substitution, last body first
    for k in range(n - 1, -1, -1):
        A, y = system.diagonal[k], system.x[k]
        for entry in range(system.first[k], system.first[k + 1]):
            right, known = system.right_of[entry], system.x[system.column[entry]]
            for i in range(_FREE):
                for j in range(_FREE):
                    y[i] -= right[i, j] * known[j]
        for i in range(_FREE - 1, -1, -1):
            for j in range(i + 1, _FREE):
                y[i] -= A[i, j] * y[j]
            y[i] /= A[i, i]
    return True
