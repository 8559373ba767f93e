//! The report of a file of results: one page with its optima, its figures, its study, and how to compute it again.

use super::html::Page;
use super::numbers::{number, unit};
use super::optima::write_optima;
use super::request::Request;
use crate::campaign::{CampaignError, KeptFront, KeptSearches, quoted, study_of};
use crate::figure::{FigureError, Picture, Shown, gain_of, picture, variables};
use crate::of::default_model;
use crate::store::catalogue::{OUTCOME, STUDY_TEXT};
use crate::store::{CaseTable, provenance};
use crate::study::{Coordinate, Drawing, Study};
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
    let mut page = Page::default();
    let kept = match KeptSearches::read(archive, &study) {
        Err(error) => {
            page.note(&format!("Motions between the cases are not shown: {error}."));
            KeptSearches::default()
        }
        Ok(kept) => kept,
    };
    kept.damage(archive).iter().for_each(|it| page.note(&format!("{it}.")));
    let fronts = kept.fronts(archive, of.gain)?;
    let report = Report { request, study: &study, kept: &kept, fronts: &fronts };
    report.write_figures(&mut page)?;
    page.part("Optima");
    let without = fronts.iter().find(|front| front.conditions.is_empty());
    for direction in DIRECTIONS {
        write_optima(&mut page, request, &study, without, direction)?;
    }
    for front in fronts.iter().filter(|front| !front.conditions.is_empty()) {
        for direction in DIRECTIONS.into_iter().filter(|it| front.has_sought(*it)) {
            write_optima(&mut page, request, &study, Some(front), direction)?;
        }
    }
    report.write_cases(&mut page)?;
    report.write_parameters(&mut page);
    report.write_study(&mut page);
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    Ok(page.finish(if study.title.is_empty() { &stem } else { &study.title }))
}

struct Report<'a> {
    request: &'a Request<'a>,
    study: &'a Study,
    kept: &'a KeptSearches,
    fronts: &'a [KeptFront],
}

impl Report<'_> {
    /// What the file holds.
    fn write_cases(&self, page: &mut Page) -> Result<(), CampaignError> {
        let Request { archive, file, .. } = self.request;
        page.part("Cases");
        let Some(table) = CaseTable::of(archive)? else {
            page.text(&format!("{} holds no cases of a sweep.", file.display()));
            return Ok(());
        };
        page.text(&format!("{} holds {} cases.", file.display(), table.cases()));
        if let Some(outcomes) = table.column(OUTCOME.name)? {
            let counts = outcomes.flags.iter().map(|(code, name)| {
                (name.clone(), outcomes.values.iter().filter(|it| **it == *code as f64).count())
            });
            let present = counts.filter(|(_, count)| *count > 0);
            let rows: Vec<_> = present.map(|(name, count)| vec![name, count.to_string()]).collect();
            page.table(&[OUTCOME.name, "cases"].map(str::to_owned), &rows);
        }
        Ok(())
    }

    /// What varies among the cases, and what is held.
    fn write_parameters(&self, page: &mut Page) {
        let varied = self.study.case_set.varied();
        page.heading("What varies");
        let rows = varied.iter().filter_map(|coordinate| {
            let [low, high] = self.study.case_set.ends(*coordinate)?.map(number);
            Some(vec![coordinate.name().to_owned(), low, high, unit(*coordinate).to_owned()])
        });
        let rows: Vec<_> = rows.collect();
        page.table(&["", "from", "to", "unit"].map(str::to_owned), &rows);
        page.heading("What is held");
        let base = &self.study.base;
        let all = base.stated().map(|(it, value)| (Coordinate::Parameter(it), value));
        let held = all.filter(|(it, _)| !varied.contains(it));
        let rows: Vec<_> = held
            .map(|(it, value)| vec![it.name().to_owned(), number(value), unit(it).to_owned()])
            .collect();
        page.table(&["", "value", "unit"].map(str::to_owned), &rows);
        let choices = base.choices().map(|(name, chosen)| {
            let mut all = base.model().choices.iter();
            let title = all.find(|it| it.name == name).map_or(name, |it| it.title);
            format!("{title}: {chosen}. ")
        });
        page.note(&format!(
            "{}Relative local error of a step: {:e}.",
            choices.collect::<String>(),
            self.study.protocol.tolerance
        ));
    }

    /// The figures of the study.
    fn write_figures(&self, page: &mut Page) -> Result<(), CampaignError> {
        page.part("Figures");
        if self.study.drawings.is_empty() {
            page.text("The study asks for none.");
        }
        for drawing in &self.study.drawings {
            match self.drawn(drawing)? {
                Ok(drawn) => {
                    let notes: String = drawn.notes.iter().map(|it| format!("; {it}")).collect();
                    let caption = format!("{}: {}{notes}", drawing.name, drawn.about);
                    page.pictures(&[drawn], &caption);
                }
                Err(error) => page.note(&format!("{}: not drawn: {error}", drawing.name)),
            }
        }
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

    /// The study, where the results come from, and how to cite and to repeat them.
    fn write_study(&self, page: &mut Page) {
        let Request { archive, file, .. } = self.request;
        let frame = archive.frame();
        page.part("Study");
        page.verbatim(frame.texts.get(STUDY_TEXT).map_or("", String::as_str));
        page.part("To compute it again");
        let file = quoted(&file.display().to_string());
        let mut commands = vec![
            format!("capsulemap inspect {file} --study > study.toml"),
            "capsulemap sweep study.toml --output again.h5".to_owned(),
        ];
        let refined = self.kept.refinements().into_iter();
        commands.extend(
            refined.map(|options| format!("capsulemap tradeoff again.h5 {options} --refine")),
        );
        let of = self.request.of;
        let gain = match of.has_own_gain() {
            true => String::new(),
            false => format!(" --for {}", of.gain.name()),
        };
        commands.push(format!("capsulemap report again.h5 --of {}{gain}", of.cost.name()));
        page.verbatim(&commands.join("\n"));
        let searches: usize = self.fronts.iter().map(|front| front.searched.searches).sum();
        if searches > 0 {
            page.note(&format!(
                "{} motions between the cases are known, from {} searches; motions under different conditions are counted apart. \
                 The commands above make the searches of the default `--starts` and `--seed` alone.",
                self.fronts.iter().map(|front| front.motions.len()).sum::<usize>(),
                searches
            ));
        }
        page.part("Where it comes from");
        let rows = frame.attributes.iter().map(|(key, value)| vec![key.clone(), value.clone()]);
        page.table(&["", ""].map(str::to_owned), &rows.collect::<Vec<_>>());
        page.part("To cite it");
        page.text(&format!("{}.", provenance::program(&frame.attributes)));
        let model = self.study.base.model();
        if model.is_or_extends(default_model()) {
            page.text(PAPER);
        }
    }
}
