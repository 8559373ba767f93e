//! A computation that another thread may stop.

use super::error::CampaignError;
use crate::flow::{Stop, stop};

/// What a computation comes to, whose motions end within a few steps once `ends` is asked; what was computed after that has no meaning.
///
/// Fails as the computation does, and with [`CampaignError::Stopped`] if it was stopped.
pub(super) fn until_stopped<T>(
    ends: &Stop,
    compute: impl FnOnce() -> Result<T, CampaignError>,
) -> Result<T, CampaignError> {
    let before = stop::current();
    stop::obey(Some(ends.clone()));
    let done = compute();
    stop::obey(before);
    if ends.is_asked() { Err(CampaignError::Stopped) } else { done }
}
