"""The capsule of Table 1 in the Filippov reading, as every peer in Python has it."""

M1 = 0.11  # kg
M2 = 0.53  # kg
K1 = 1420.0  # N/m
C = 3.89  # N s/m
V_S = 0.3  # m/s
NORMAL_LOAD = (M1 + M2) * 9.81  # N
# The force that ends rest; with mu_s = 2 mu_d also the friction at vanishing speed.
BREAK_AWAY = 0.66 * NORMAL_LOAD
SLIDING = 0.33 * NORMAL_LOAD  # times 1 + exp(-|y2| / V_S)
