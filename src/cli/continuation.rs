//! `capsulemap continue`: the branches and ramps of a study and the boundaries of its map, into the file of its results.

use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;

use super::boundary_summary;
use super::branch_summary::summary;
use super::drawing::{FormatChoice, draw_from, formats, rehearse};
use super::failure::Failure;
use super::ramp_summary;
use super::terminal::{notify, print};
use super::watch::Watch;
use crate::campaign::{
    Beside, BranchesDone, Campaign, CampaignError, Event, Kept, output_path, read_study,
};
use crate::figure::Place;
use crate::quantity::printable::printable;
use crate::run::Machine;
use crate::store::{self, Archive, folder};

const EXAMPLES: &str = "\
Examples:
  capsulemap continue studies/hysteresis.toml
  capsulemap continue STUDY.toml --output /data/branches.h5 --threads 2
  capsulemap sweep STUDY.toml && capsulemap continue STUDY.toml --formats pdf";

/// Continue periodic orbits in parameters, and follow motions along ramps of them and the boundaries of maps.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Continue {
    /// The study, a TOML file with [[branches]], [[ramps]], or a [map] with boundaries, which `sweep` has computed.
    study: PathBuf,
    /// The file to add them to; results/NAME/NAME.h5 for a study NAME.toml by default.
    #[arg(long, value_name = "FILE.h5")]
    output: Option<PathBuf>,
    /// Worker threads; one per core by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Continue and follow them again, and replace a file of results that another study left under that name, and files
    /// in the place of figures.
    #[arg(long)]
    overwrite: bool,
    /// Do not draw the study's figures.
    #[arg(long)]
    no_figures: bool,
    /// File formats of the figures.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "png,svg,pdf")]
    formats: Vec<FormatChoice>,
}

impl Continue {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let name = printable(&self.study).to_string();
        let study = read_study(&self.study)?;
        if !study.has_more_than_cases() {
            let message = format!(
                "{name}: asks for no [[branches]], no [[ramps]] and no boundaries of a [map]; capsulemap help study lists their keys"
            );
            return Err(Failure::request(message));
        }
        let notes = study.remarks.iter().cloned().chain(study.branches_without_effect());
        notes.for_each(|why| notify(&format!("note: {why}")));
        let output = output_path(&self.study, self.output.as_deref())?;
        let machine = Machine { threads: self.threads.map(usize::from), instructions: None };
        let overwrite = self.overwrite;
        let campaign = Campaign { study: &study, output: &output, machine, overwrite };
        let formats = formats(&self.formats);
        let place = Place { folder: folder(&output), formats: &formats, overwrite };
        let archive = self.continued(&campaign, &place)?;
        if !self.no_figures {
            draw_from(&archive, &study, &place)?;
        }
        Ok(())
    }

    /// The file with the branches and ramps, which are computed unless they are there.
    fn continued(&self, campaign: &Campaign<'_>, place: &Place<'_>) -> Result<Archive, Failure> {
        let Campaign { study, output, .. } = *campaign;
        let watch = Watch::new(&self.study, study);
        let done = campaign.continue_branches(&|event| match event {
            Event::Before { .. } => {
                let shown = printable(output);
                notify(&format!(
                    "{shown}: branches and ramps are there already, by this program from this study"
                ));
                ControlFlow::Continue(())
            }
            Event::Accepted(older) => watch.heed(self.rehearse(campaign, older, place)),
            other => watch.hear(other),
        });
        if let Err(error @ CampaignError::OtherBranches { .. }) = done {
            let advice = "--overwrite computes branches and ramps again and keeps the cases";
            return Err(Failure::request(format!("{error}; {advice}")));
        }
        match watch.end(done)? {
            BranchesDone::Before(file) => Ok(file.archive),
            BranchesDone::Now { found, time } => {
                let of_ramps = ramp_summary::summary(study, &found.ramped);
                let of_boundaries = study.boundaries.zip(found.boundaries.as_ref());
                let of_boundaries =
                    of_boundaries.map(|(asked, it)| boundary_summary::summary(&asked, it));
                let of_branches = summary(study, &found, output, time.as_secs_f64());
                print(&(of_branches + &of_ramps + &of_boundaries.unwrap_or_default()))?;
                store::open(output).map_err(Failure::machine)
            }
        }
    }

    /// Draws the figures as if no branch could be continued, no ramp followed and no boundary located.
    fn rehearse(
        &self,
        campaign: &Campaign<'_>,
        older: Option<&Kept>,
        place: &Place<'_>,
    ) -> Result<(), Failure> {
        if self.no_figures {
            return Ok(());
        }
        let study = campaign.study;
        let mut dataset = campaign.without_branches(older, |_| true)?;
        Beside::none(study).put_into(&mut dataset, study);
        let drawn = rehearse(&dataset, study, place);
        drawn.map_err(|failure| failure.within(&printable(&self.study).to_string()))
    }
}
