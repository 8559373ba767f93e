//! Studies that together have all variables that a file of results can have.

/// Studies that together have all that a file of results can hold.
pub(super) const STUDIES: [&str; 8] = [
    r#"
[parameters]
m2 = "0.2 kg"
c = "1.77 N s/m"
mu_s = 0.33
mu_d = 0.165
p_d = "2.79 N"
k2 = "65.518 kN/m"
delta = "4.33 mm"
[[axes]]
name = "omega"
from = "118 rad/s"
to = "132 rad/s"
points = 71
[start]
inherit = "omega"
directions = ["upward", "downward"]
[history]
cycles = 2
samples_per_cycle = 12
[protocol]
points = 6
impact_points = 4
exponents = "all"
[[branches]]
name = "moving on"
along = "omega"
at = { omega = "130 rad/s" }
start = { y1 = "0.3 m/s" }
second = { name = "p_d", from = "2.7 N", to = "2.9 N" }
[[ramps]]
name = "a fast rise"
along = "omega"
from = "150 rad/s"
to = "172 rad/s"
rate = "5 rad/s^2"
start = { y1 = "0.3 m/s" }
"#,
    r#"
[parameters]
k2 = "86.8 kN/m"
delta = "2.45 mm"
p_d = "3.4 N"
omega = "39 rad/s"
[[axes]]
name = "start_y1"
values = ["-0.4 m/s", "0.4 m/s"]
[protocol]
max_cycles = 200
exponents = "all"
"#,
    r#"
[parameters]
k2 = "86.8 kN/m"
delta = "2.45 mm"
p_d = "3.4 N"
omega = "39 rad/s"
[draws]
kind = "low-discrepancy"
count = 8
seed = 3
[[axes]]
name = "start_y1"
from = "-0.4 m/s"
to = "0.4 m/s"
"#,
    r#"
[parameters]
k2 = "60 kN/m"
c = "0.2 N s/m"
mu_s = 0.3
mu_d = 0.25
delta = "2 mm"
omega = "45 rad/s"
p_d = "5.375 N"
[[axes]]
name = "start_r"
from = "-30 mm"
to = "5 mm"
points = 64
[[axes]]
name = "start_y1"
from = "-1 m/s"
to = "1 m/s"
points = 64
[basin]
manifolds = true
"#,
    r#"
[parameters]
m2 = "0.2 kg"
c = "1.77 N s/m"
mu_s = 0.33
mu_d = 0.165
p_d = "2.79 N"
k2 = "65.518 kN/m"
delta = "4.33 mm"
omega = "155 rad/s"
[[axes]]
name = "start_y1"
from = "-1.5 m/s"
to = "1.5 m/s"
points = 130
[basin]
refine = true
"#,
    r#"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
[[axes]]
name = "p_d"
from = "1 N"
to = "3 N"
points = 129
[[axes]]
name = "omega"
from = "20 rad/s"
to = "22 rad/s"
points = 2
[map]
refine = { progression_speed = "1 mm/s", work_positive = "1 mJ" }
boundaries = { most_tries = 2 }
"#,
    r#"
[parameters]
delta = "3.5 mm"
p_d = "4 N"
drive = "trapezoid"
drive_period = "80 ms"
p_0 = "0.1 N"
p_low = "-2 N"
duty = 0.4
rise = 0.1
p_2 = "0 N"
phase_2 = "0 rad"
incline = "1 deg"
load = "0.01 N"
preload_gap = "0.1 mm"
k3 = "20 kN/m"
delta_3 = "4 mm"
k2_damping = "0.1 N s/m"
k3_damping = "0.1 N s/m"
restitution = 0.5
release = "force"
xi_1 = "1 mm"
xi_2 = "1 mm"
stroke = "1 mm"
share_1 = 0.2
share_2 = 0.3
k1_cubic = "1e5 N/m3"
k2_cubic = "1e6 N/m3"
mu_s_forward = 0.6
mu_s_backward = 0.7
mu_d_forward = 0.3
mu_d_backward = 0.35
stribeck = 0.9
c1_forward = "0.1 N s/m"
c1_backward = "0.2 N s/m"
c2_forward = "0.1 N s2/m2"
c2_backward = "0.2 N s2/m2"
[protocol]
points = 1
impact_points = 0
[[branches]]
name = "b"
along = "delta_3"
from = "3.9 mm"
to = "4.1 mm"
"#,
    r#"
[parameters]
m2 = "0.2 kg"
c = "1.77 N s/m"
mu_s = 0.33
mu_d = 0.165
k2 = "65.518 kN/m"
delta = "4.33 mm"
[[axes]]
name = "line"
from = { omega = "140 rad/s", p_d = "2.6 N" }
to = { omega = "180 rad/s", p_d = "3 N" }
points = 9
[start]
y1 = "0.3 m/s"
inherit = "line"
directions = ["upward", "downward"]
"#,
];
