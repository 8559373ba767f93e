//! What is said of the claims of processes that share a study.

use std::collections::BTreeMap;

use super::readable::{counted, time};
use crate::campaign::count::ranges;
use crate::campaign::{Abandoned, ClaimStatus};
use crate::quantity::printable::one_line;
use crate::store::Owner;

/// What is claimed, an entry for each process: "2 blocks claimed by process 71 on node3: 4, 9".
pub fn claimed(claims: &[ClaimStatus]) -> Vec<String> {
    let mut of_process: BTreeMap<String, (Vec<usize>, bool)> = BTreeMap::new();
    for claim in claims {
        let ended = if claim.has_ended { ", which does not run any more" } else { "" };
        let who = process(claim.owner.as_ref()) + ended;
        let (blocks, joins) = of_process.entry(who).or_default();
        blocks.extend(claim.block);
        *joins |= claim.block.is_none();
    }
    let entries = of_process.into_iter().map(|(who, (blocks, joins))| match joins {
        true => format!("the join of all blocks, claimed by {who}"),
        false => {
            let (count, numbers) = (counted(blocks.len(), "block"), ranges(blocks.into_iter()));
            format!("{count} claimed by {who}: {numbers}")
        }
    });
    entries.collect()
}

/// Whose claim is taken over, and why.
pub fn taken_over(block: Option<usize>, owner: Option<&Owner>, why: Abandoned) -> String {
    let what = block.map_or("the join of all blocks".to_owned(), |block| format!("block {block}"));
    let why = match (why, owner) {
        (Abandoned::Ended, _) => "which does not run any more".to_owned(),
        (Abandoned::Silent, Some(owner)) => {
            format!("which has not renewed its claim for {}", time(owner.limit().as_secs_f64()))
        }
        (Abandoned::Silent, None) => "whose claim cannot be read".to_owned(),
    };
    format!("{what}: taken over from {}, {why}", process(owner))
}

/// A process by its number and machine.
fn process(owner: Option<&Owner>) -> String {
    match owner {
        Some(Owner { host, process, .. }) => format!("process {process} on {}", one_line(host)),
        None => "a process that is not known".to_owned(),
    }
}
