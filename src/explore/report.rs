//! The report of a file of results: one page with what was computed, what came of it, and how to compute it again.

use super::computation::write_computation;
use super::figure_captions::{caption, mention};
use super::html::{Item, Page, Prose};
use super::optima::{gain_in_words, write_optima};
use super::outcomes::write_outcomes;
use super::request::Request;
use super::table::{Cell, Column, Table};
use crate::campaign::count::counted;
use crate::campaign::{CampaignError, KeptFront, KeptSearches, quoted, study_of};
use crate::figure::{FigureError, Picture, Shown, gain_of, picture, variables};
use crate::of::default_model;
use crate::quantity::printable::printable;
use crate::store::catalogue::STUDY_TEXT;
use crate::store::{CaseTable, provenance};
use crate::study::{Drawing, Study};
use crate::tradeoff::Direction;

/// The directions whose optima are told.
const DIRECTIONS: [Direction; 2] = [Direction::Forward, Direction::Backward];
/// The paper whose system the capsule is.
const PAPER: &str = "Y. Liu, H. Jiang, E. Pavlovskaia, M. Wiercigroch: Experimental investigation of the vibro-impact \
     capsule system. Procedia IUTAM (2017).";

/// The report as one HTML page that needs nothing else: the same bytes for the same file, searches and request.
///
/// The optima are of the cases and of the motions between them that [`KeptSearches`] has; none is sought here. What cannot be
/// told or drawn is named with the reason.
///
/// Fails if the file cannot be read or a motion cannot be computed again.
pub fn report(request: &Request<'_>) -> Result<String, CampaignError> {
    let Request { archive, file, of } = *request;
    let study = study_of(archive, file)?;
    let (kept, unread) = match KeptSearches::read(archive, &study) {
        Err(error) => {
            let note = format!("Motions between the cases are not shown: {error}.");
            (KeptSearches::default(), Some(note))
        }
        Ok(kept) => (kept, None),
    };
    let fronts = kept.fronts(archive, of.gain)?;
    let report = Report { request, study: &study, kept: &kept, fronts: &fronts };
    let mut page = Page::default();
    let cases = CaseTable::of(archive)?.map(|it| it.cases());
    write_computation(&mut page, &study, cases);
    write_outcomes(&mut page, archive, &study)?;
    report.write_figures(&mut page)?;
    page.section("Optima");
    unread.iter().for_each(|it| page.note(it));
    kept.damage(archive).iter().for_each(|it| page.note(&format!("{it}.")));
    report.write_optima(&mut page)?;
    report.write_again(&mut page);
    report.write_origin(&mut page);
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let title = if study.title.is_empty() { &stem } else { study.title.as_str() };
    Ok(page.finish(title, &report.facts()))
}

struct Report<'a> {
    request: &'a Request<'a>,
    study: &'a Study,
    kept: &'a KeptSearches,
    fronts: &'a [KeptFront],
}

impl Report<'_> {
    /// What stands below the title.
    fn facts(&self) -> Vec<(&'static str, String)> {
        let Request { archive, file, .. } = self.request;
        let attributes = &archive.frame().attributes;
        let created = attributes.get(provenance::CREATED).map_or("unknown", String::as_str);
        vec![
            ("Kind", "Report of a computation".to_owned()),
            ("Results", printable(file).to_string()),
            ("Written", created.replace('T', " ").replace('Z', " UTC")),
            ("Program", provenance::program(attributes)),
            ("Model", self.study.base.model().name.to_owned()),
        ]
    }

    /// The figures of the study.
    fn write_figures(&self, page: &mut Page) -> Result<(), CampaignError> {
        page.section("Figures");
        if self.study.drawings.is_empty() {
            page.text("The study asks for none.");
        }
        let (mut drawn, mut missing) = (Vec::new(), Vec::new());
        for drawing in &self.study.drawings {
            match self.drawn(drawing)? {
                Ok(picture) => drawn.push((drawing, picture)),
                Err(error) => missing.push(format!("{}: not drawn: {error}", drawing.name)),
            }
        }
        write_list_of_figures(page, &drawn);
        for (drawing, picture) in drawn {
            let caption = caption(drawing, &picture, self.study.base.model());
            page.pictures(&[picture], &caption);
        }
        missing.iter().for_each(|it| page.note(it));
        Ok(())
    }

    fn drawn(&self, drawing: &Drawing) -> Result<Result<Picture, FigureError>, CampaignError> {
        let shown = variables(drawing, self.request.archive.frame().model());
        let dataset = self.request.archive.labelled(|name| shown.contains(name))?;
        let refined = self.refined(drawing)?;
        Ok(picture(Shown { dataset: &dataset, refined: &refined, measured: None }, drawing))
    }

    /// What was found between the cases for the gain that a figure shows, if it shows such motions.
    fn refined(&self, drawing: &Drawing) -> Result<Vec<KeptFront>, CampaignError> {
        let archive = self.request.archive;
        let gain = gain_of(drawing, archive.frame().model());
        match gain.filter(|_| drawing.kind.keys().between) {
            Some(gain) => self.kept.fronts(archive, gain),
            None => Ok(Vec::new()),
        }
    }

    /// The optima without conditions, and those under each condition that something was sought under.
    fn write_optima(&self, page: &mut Page) -> Result<(), CampaignError> {
        let without = self.fronts.iter().find(|front| front.conditions.is_empty());
        for direction in DIRECTIONS {
            write_optima(page, self.request, self.study, without, direction)?;
        }
        for front in self.fronts.iter().filter(|front| !front.conditions.is_empty()) {
            for direction in DIRECTIONS.into_iter().filter(|it| front.has_sought(*it)) {
                write_optima(page, self.request, self.study, Some(front), direction)?;
            }
        }
        Ok(())
    }

    /// The commands that compute all of it again, and the study.
    fn write_again(&self, page: &mut Page) {
        page.section("To compute it again");
        page.verbatim(&self.commands().join("\n"));
        let searches: usize = self.fronts.iter().map(|front| front.searched.searches).sum();
        if searches > 0 {
            page.note(&format!(
                "{} between the cases are known, from {searches} searches for {}; motions under different conditions are counted apart. \
                 The commands above make the searches of the default `--starts` and `--seed` alone.",
                counted(self.fronts.iter().map(|front| front.motions.len()).sum(), "motion"),
                gain_in_words(self.request.of)
            ));
        }
        page.subsection("Study");
        let frame = self.request.archive.frame();
        page.verbatim(frame.texts.get(STUDY_TEXT).map_or("", String::as_str));
    }

    /// The commands, one a line.
    fn commands(&self) -> Vec<String> {
        let Request { file, of, .. } = *self.request;
        let file = quoted(&file.display().to_string());
        let mut commands = vec![
            format!("capsulemap inspect {file} --study > study.toml"),
            "capsulemap sweep study.toml --output again.h5".to_owned(),
        ];
        let refined = self.kept.refinements().into_iter();
        commands.extend(
            refined.map(|options| format!("capsulemap tradeoff again.h5 {options} --refine")),
        );
        let gain = match of.has_own_gain() {
            true => String::new(),
            false => format!(" --for {}", of.gain.name()),
        };
        commands.push(format!("capsulemap report again.h5 --of {}{gain}", of.cost.name()));
        commands
    }

    /// Where the results come from, and how to cite them.
    fn write_origin(&self, page: &mut Page) {
        let attributes = &self.request.archive.frame().attributes;
        page.section("Provenance");
        let text = Prose::from("What the file says of its origin and of the protocol is in ");
        page.text(text.see(page.next_table()).and("."));
        let rows = attributes.iter().map(|(key, value)| vec![Cell::text(key), Cell::text(value)]);
        page.table(&Table {
            caption: "The attributes of the file.".to_owned(),
            columns: vec![Column::text("attribute"), Column::long("value")],
            rows: rows.collect(),
        });
        page.section("Citation");
        page.text(format!("{}.", provenance::program(attributes)));
        if self.study.base.model().is_or_extends(default_model()) {
            page.text(PAPER);
        }
    }
}

/// Says which figure shows what, where there are several.
fn write_list_of_figures(page: &mut Page, drawn: &[(&Drawing, Picture)]) {
    let Item::Figure(first) = page.next_figure() else { return };
    match drawn.len() {
        0 => return,
        1 => {
            return page.text(Prose::from("The study asks for ").see(Item::Figure(first)).and("."));
        }
        _ => {}
    }
    let mut text = Prose::from(format!("The study asks for {}: ", counted(drawn.len(), "figure")));
    for (place, (drawing, _)) in drawn.iter().enumerate() {
        let name = mention(drawing);
        let end = if place + 1 < drawn.len() { ", " } else { "." };
        text =
            text.and(&format!("{name} (")).see(Item::Figure(first + place)).and(&format!("){end}"));
    }
    page.text(text);
}
