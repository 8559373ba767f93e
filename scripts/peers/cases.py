"""The cases that every program computes: those of benches/cycles.rs, from rest."""

FIG_5 = (2420.0, 77.91, 4.0, 0.0035)  # k2 N/m, omega rad/s, p_d N, delta m
FIG_6 = (18960.0, 20.73, 4.0, 0.0015)
# So many copies of a figure's one case fill any number of lanes up to 64.
COPIES = 64


def along(index, start, end):
    """Return a value of an axis of the grid."""
    return start + (end - start) * index / 31.0


GRID = [
    (18960.0, along(i % 32, 10.0, 100.0), along(i // 32, 1.0, 6.0), 0.0015)
    for i in range(32 * 32)
]

# The map of periods is that of a capsule with less damping than Table 1's, in which few
# periods are longer than one: so is `--settle` of benches/peers.rs.
MAP_DAMPING = 0.9  # N s/m


def case_sets(short):
    """Return the number of cycles and the sets of cases by name."""
    if short:
        # Every 13th case: all frequencies and amplitudes have their share.
        return 20, {"Fig 5": [FIG_5] * 16, "Fig 6": [FIG_6] * 16, "grid": GRID[::13]}
    cases = {"Fig 5": [FIG_5] * COPIES, "Fig 6": [FIG_6] * COPIES}
    return 100, cases | {"grid": GRID}


def sample(cases):
    """Return the indices of the few cases that a slow program computes."""
    if cases[0] == cases[-1]:
        return [0]
    # A spacing that shares no factor with the grid's 32 columns.
    return list(range(0, len(cases), 61 if len(cases) > 100 else 16))
