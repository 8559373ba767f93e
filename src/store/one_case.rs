//! What a file of results has of one case.

use super::catalogue::section;
use super::{Archive, StoreError};
use crate::description::Section;

impl Archive {
    /// The first number that the case at a position along the axes has of a variable; NaN if there is none.
    pub fn first(&self, name: &str, position: &[usize]) -> Result<f64, StoreError> {
        let rows = self.rows(name, &[position.to_vec()])?;
        let first = rows.first().and_then(|row| row.to_real().into_iter().next());
        Ok(first.unwrap_or(f64::NAN))
    }

    /// The first section point that is kept of the motion of the case at a position, if one is.
    pub fn section_point(&self, position: &[usize]) -> Result<Option<Section>, StoreError> {
        let coordinates = section(self.frame().model()).into_iter();
        let point: Section = coordinates
            .map(|entry| self.first(entry.name, position))
            .collect::<Result<_, StoreError>>()?;
        Ok(Some(point).filter(|point| point.iter().all(|it| it.is_finite())))
    }
}
