//! What kept searches for a gain have found, apart by the conditions that they have kept: motions under different conditions make no
//! common front.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::Value;

use super::answer::Searched;
use super::error::CampaignError;
use super::kept_searches::{FOR, KeptSearches};
use super::refined_motion::{RefinedMotion, distinct};
use crate::description::Output;
use crate::store::{Archive, CaseTable, Unread, conditions, fulfils};
use crate::tradeoff::{Direction, GainAndCost};

/// What searches under the same conditions have found between the cases of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptFront {
    /// The conditions, each as `--where` takes it; none where the motions were sought without any.
    pub conditions: Vec<String>,
    /// Whether each case keeps the conditions, in the order of the cases; empty where there are none.
    pub keeps: Vec<bool>,
    /// The searches.
    pub searched: Searched,
    /// The motions found, each once, in an order that does not depend on that of the searches.
    pub motions: Vec<RefinedMotion>,
}

/// The searches under the same conditions.
#[derive(Default)]
struct Group {
    directions: BTreeSet<String>,
    starts: BTreeSet<String>,
    searches: usize,
    unsettled: usize,
    found: Vec<RefinedMotion>,
}

impl KeptFront {
    /// The conditions in one text, as `--where` takes it.
    pub fn condition(&self) -> String {
        self.conditions.join(" and ")
    }

    /// Whether a case keeps the conditions.
    pub fn has(&self, case: usize) -> bool {
        self.conditions.is_empty() || self.keeps.get(case) == Some(&true)
    }

    /// Whether motions in a direction were sought.
    pub fn has_sought(&self, direction: Direction) -> bool {
        self.searched.directions.iter().any(|it| *it == direction || *it == Direction::Either)
    }
}

impl KeptSearches {
    /// What searches for a gain have found, apart by their conditions: first what was found without any, if that was sought, then the others in
    /// the order of their conditions.
    ///
    /// Fails if the file of results cannot be read, or has no more what a condition is on.
    pub fn fronts(&self, archive: &Archive, gain: Output) -> Result<Vec<KeptFront>, CampaignError> {
        let mut groups: BTreeMap<Vec<String>, Group> = BTreeMap::new();
        for (what, led) in self.each() {
            let what: Value = serde_json::from_str(what).unwrap_or_default();
            if !is_for(&what, gain) {
                continue;
            }
            let conditions = what["where"].as_array().map_or(&[][..], Vec::as_slice);
            let conditions = conditions.iter().filter_map(|it| Some(it.as_str()?.to_owned()));
            let group = groups.entry(conditions.collect()).or_default();
            group.directions.extend(what["moving"].as_str().map(str::to_owned));
            // A front that is followed goes on from motions that searches have found.
            group.starts.extend(what.get("prices").is_none().then(|| what["from"].to_string()));
            group.searches += 1;
            group.unsettled += led.unsettled;
            group.found.extend(led.motions.iter().cloned());
        }
        let table = CaseTable::of(archive)?;
        let path = archive.path();
        groups.into_iter().map(|(asked, group)| group.front(asked, &table, path)).collect()
    }
}

impl Group {
    fn front(
        self,
        asked: Vec<String>,
        table: &Option<CaseTable<'_>>,
        path: &Path,
    ) -> Result<KeptFront, CampaignError> {
        let sought = Direction::NAMES.iter().filter(|it| self.directions.contains(it.0));
        let directions = sought.map(|it| it.1).collect();
        let keeps = match table.as_ref().filter(|_| !asked.is_empty()) {
            Some(table) => keeping(table, &asked, path)?,
            None => Vec::new(),
        };
        Ok(KeptFront {
            conditions: asked,
            keeps,
            searched: Searched {
                searches: self.searches,
                starts: self.starts.len(),
                unsettled: self.unsettled,
                directions,
            },
            motions: distinct(self.found),
        })
    }
}

/// Whether a search was for a gain: for that of the model where it names none.
fn is_for(what: &Value, gain: Output) -> bool {
    match what[FOR].as_str() {
        Some(name) => name == gain.name(),
        None => GainAndCost::own_gain(gain.model()) == Some(gain),
    }
}

/// Whether each case keeps conditions.
///
/// Fails if the file at `path` cannot be read, or lacks what a condition is on.
fn keeping(
    table: &CaseTable<'_>,
    asked: &[String],
    path: &Path,
) -> Result<Vec<bool>, CampaignError> {
    match conditions(table, &asked.join(" and ")) {
        Ok(found) => Ok((0..table.cases()).map(|case| fulfils(&found, case)).collect()),
        Err(Unread::Store(error)) => Err(error.into()),
        Err(Unread::Faults(faults)) => {
            Err(CampaignError::TradeOff { path: path.to_owned(), faults })
        }
    }
}
