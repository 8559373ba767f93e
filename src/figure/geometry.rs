//! Places on the page, in points from its upper left corner.

/// A point of the page [pt], from its upper left corner.
pub type Point = (f64, f64);

/// A rectangle of the page [pt].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// Left side.
    pub left: f64,
    /// Upper side.
    pub top: f64,
    /// Right side.
    pub right: f64,
    /// Lower side.
    pub bottom: f64,
}

impl Rect {
    /// Extent along the page's width.
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    /// Extent along the page's height.
    pub fn height(&self) -> f64 {
        self.bottom - self.top
    }
}
