//! The laws of resistance to the capsule, and how friction switches, by name.

/// The law of resistance to the capsule's motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Resistance {
    /// `mu_d (1 + exp(-|y2|/v_s)) N` against the motion; the paper's law.
    #[default]
    CoulombStribeck,
    /// `mu_d N` against the motion.
    Coulomb,
    /// `c1 y2 + c2 |y2| y2` against the motion; nothing sticks in a medium (paper, Fig 1b).
    Medium,
}

impl Resistance {
    /// Every law by its name in studies, files and on the command line, in the order of declaration.
    pub const NAMES: [(&str, Resistance); 3] = [
        ("coulomb-stribeck", Resistance::CoulombStribeck),
        ("coulomb", Resistance::Coulomb),
        ("medium", Resistance::Medium),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        Resistance::NAMES[self as usize].0
    }
}

/// How the friction switches between sticking and slipping.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Switching {
    /// Friction is set-valued at rest: the capsule slips until it stops, and rests until broken away.
    #[default]
    Filippov,
    /// Eq. (1) of the paper to the letter: the capsule freezes while |F| <= f_s, even at speed.
    AsPrinted,
}

impl Switching {
    /// Every reading by its name in studies, files and on the command line, in the order of declaration.
    pub const NAMES: [(&str, Switching); 2] =
        [("filippov", Switching::Filippov), ("as-printed", Switching::AsPrinted)];

    /// Its name.
    pub fn name(self) -> &'static str {
        Switching::NAMES[self as usize].0
    }
}
