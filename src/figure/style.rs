//! Typography, line widths and colours: the one place where the look of every figure is decided.

use plotters::style::RGBColor;

/// Family of the embedded font, as the drawing names it.
pub const FAMILY: &str = "Libertinus Serif";
/// Points in a millimetre.
pub const POINTS_PER_MM: f64 = 72.0 / 25.4;
/// Resolution of PNG files, and of the rasters inside figures, so that no pixel is lost between
/// them [dots per inch].
pub const DPI: f64 = 600.0;

/// Resolution of pictures for a screen [dots per inch].
pub const SCREEN_DPI: f64 = 220.0;

/// One column of a journal [mm].
pub const ONE_COLUMN: f64 = 88.0;
/// Two columns of a journal [mm].
pub const TWO_COLUMNS: f64 = 180.0;

/// Size of headings [pt].
pub const TITLE_SIZE: f64 = 10.0;
/// Size of axis labels and panel letters [pt].
pub const LABEL_SIZE: f64 = 9.0;
/// Size of tick labels, notes and legends [pt].
pub const SMALL_SIZE: f64 = 8.0;

/// Distance between lines relative to the size of their text.
pub const LINE_HEIGHT: f64 = 1.15;

/// Width of frames and ticks [pt].
pub const FRAME_WIDTH: f64 = 0.6;
/// Width of minor ticks [pt].
pub const MINOR_WIDTH: f64 = 0.4;
/// Width of curves [pt].
pub const CURVE_WIDTH: f64 = 0.9;
/// Width of reference lines [pt].
pub const REFERENCE_WIDTH: f64 = 0.7;
/// Length of major ticks [pt].
pub const MAJOR_LENGTH: f64 = 3.5;
/// Length of minor ticks [pt].
pub const MINOR_LENGTH: f64 = 2.0;

/// Empty border of the page [pt].
pub const BORDER: f64 = 3.0;
/// Distance between a frame and its tick labels [pt].
pub const TICK_GAP: f64 = 3.5;
/// Distance between tick labels and the axis label [pt].
pub const LABEL_GAP: f64 = 3.0;
/// Room above a frame for the panel letter, a note and the legend [pt].
pub const HEADER: f64 = 14.0;
/// Distance between panels of a grid [pt].
pub const PANEL_GAP: f64 = 9.0;

/// Points above which a cloud is drawn as a raster.
pub const CLOUD_LIMIT: usize = 5000;

/// Text, frames and ticks.
pub const INK: RGBColor = RGBColor(0, 0, 0);
/// Text that steps back.
pub const FAINT_INK: RGBColor = RGBColor(90, 90, 90);
/// First colour of curves (blue).
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
/// Second colour of curves (vermilion).
pub const VERMILION: RGBColor = RGBColor(213, 94, 0);
/// Third colour of curves (bluish green).
pub const GREEN: RGBColor = RGBColor(0, 158, 115);
/// Fourth colour of curves (reddish purple).
pub const PURPLE: RGBColor = RGBColor(176, 74, 138);
/// What nothing is drawn on.
pub const PAPER: RGBColor = RGBColor(255, 255, 255);
/// Shading of the side of the impact surface where the spring is compressed.
pub const CONTACT: RGBColor = RGBColor(236, 236, 236);
/// Cells without a value.
pub const MISSING: RGBColor = RGBColor(226, 226, 226);
/// Hatching over cells without a value.
pub const HATCH: RGBColor = RGBColor(160, 160, 160);
/// Cells whose value is infinite.
pub const INFINITE: RGBColor = RGBColor(120, 120, 120);

/// Colours of periods 1 to 8, after Tol's muted set, which the colour-blind can distinguish.
pub const PERIODS: [RGBColor; 8] = [
    RGBColor(136, 204, 238),
    RGBColor(51, 34, 136),
    RGBColor(221, 204, 119),
    RGBColor(17, 119, 51),
    RGBColor(204, 102, 119),
    RGBColor(136, 34, 85),
    RGBColor(68, 170, 153),
    RGBColor(153, 153, 51),
];
/// Periods above 8.
pub const LONG_PERIOD: RGBColor = RGBColor(170, 68, 153);
/// Colours of attractors, after Okabe and Ito, which the colour-blind can distinguish.
pub const ATTRACTORS: [RGBColor; 7] = [
    BLUE,
    VERMILION,
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(136, 34, 85),
];
/// Radius of a section point over an area [pt].
pub const POINT_RADIUS: f64 = 2.4;
/// Width of its rim [pt].
pub const POINT_RIM: f64 = 0.7;
/// Attractors beyond these.
pub const OTHER_ATTRACTOR: RGBColor = RGBColor(90, 90, 90);
/// Points of cases without a known attractor.
pub const UNDECIDED_DOT: RGBColor = RGBColor(175, 175, 175);
/// Shading of windows in which attractors coexist.
pub const COEXISTENCE: RGBColor = RGBColor(244, 237, 218);
/// Chaotic motion.
pub const CHAOTIC: RGBColor = RGBColor(20, 20, 20);
/// Quasi-periodic motion.
pub const QUASI_PERIODIC: RGBColor = RGBColor(238, 119, 51);
/// Cases that have not been computed yet.
pub const NOT_YET: RGBColor = RGBColor(228, 228, 228);
/// A case that is inferred from those around it.
pub const INFERRED: RGBColor = RGBColor(205, 222, 238);
/// Motion that is undecided within the budget of cycles.
pub const UNDECIDED: RGBColor = RGBColor(136, 136, 136);
