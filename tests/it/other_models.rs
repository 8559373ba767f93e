//! A model that the program does not know: registered here, and swept, resumed, drawn and continued by the same code as the capsule.

use std::ops::ControlFlow;
use std::sync::LazyLock;

use capsulemap::campaign::{Campaign, Event, Task, silent};
use capsulemap::description::Parameter;
use capsulemap::figure::draw;
use capsulemap::model::Setting;
use capsulemap::of::{all_models, register};
use capsulemap::orbit::Outcome;
use capsulemap::store::{self, Archive};
use capsulemap::study::{Drawing, DrawingKind, Study};
use capsulemap_oscillators::{IMPACT, IMPACT_OSCILLATOR, Impactor, settled};

use super::campaign::place::{after, parse, place, timeless, uninterrupted};
use super::figure::{ALL, drawing, folder, into};

/// A line of walls that the mass meets in some, both ways, and a branch along it.
const LINE: &str = "model = \"impact-oscillator\"
[[axes]]
name = \"wall\"
from = \"0.4\"
to = \"1.2\"
points = 200
[[axes]]
name = \"c\"
values = [\"0.1\", \"0.2\", \"0.3\"]
[start]
inherit = \"wall\"
directions = [\"upward\", \"downward\"]
[protocol]
points = 8
[[branches]]
name = \"of the middle\"
along = \"wall\"
from = \"0.4\"
to = \"1.2\"
at = { wall = \"1.1\", c = \"0.1\" }
orbit = \"newton\"
period = 1
start = { x = \"-0.79\", v = \"0.14\" }
";

/// Starts of one oscillator, of which some never meet the wall again and others always do.
const STARTS: &str = "model = \"impact-oscillator\"
[[axes]]
name = \"start_x\"
from = \"-3\"
to = \"0.9\"
points = 40
[[axes]]
name = \"start_v\"
from = \"-3\"
to = \"3\"
points = 40
";

/// The study in `text`, whose model is known by then.
fn study(text: &str) -> Study {
    static KNOWN: LazyLock<()> = LazyLock::new(|| register(IMPACT).expect("its name is free"));
    LazyLock::force(&KNOWN);
    parse(text)
}

fn swept(text: &str) -> (tempfile::TempDir, Archive) {
    let (folder, output) = place();
    let study = study(text);
    let campaign = Campaign::new(&study, &output);
    campaign.run(Task::WHOLE, &silent).expect("the study runs");
    if !study.branches.is_empty() {
        campaign.continue_branches(&silent).expect("the branches are continued");
    }
    (folder, store::open(&output).expect("a result"))
}

#[test]
fn a_registered_model_is_known_by_its_name_alone() {
    let study = study(LINE);
    assert!(*study.base.model() == IMPACT_OSCILLATOR && all_models().len() == 3);
    assert!(register(IMPACT).is_err());
    let said =
        Study::parse("study.toml", &LINE.replace("impact-", "impakt-")).expect_err("unknown");
    let said = said.to_string();
    assert!(said.contains("model: unknown model \"impakt-oscillator\""), "{said}");
    assert!(said.contains("impact-oscillator"), "{said}");
    // What only the capsule has is unknown here.
    let said = Study::parse("study.toml", &LINE.replace("\"c\"", "\"k2\"")).expect_err("no k2");
    assert!(said.to_string().contains("axes[2].name"), "{said}");
}

#[test]
fn its_cases_are_those_of_the_engine_and_of_the_closed_form() {
    let (_folder, archive) = swept(LINE);
    let study = study(LINE);
    let whole = archive.dataset(|_, _| true).expect("it reads back");
    assert!(*whole.model() == IMPACT_OSCILLATOR);
    assert!(whole.variable("section_r").is_none() && whole.variable("progression_speed").is_none());
    let of = |name: &str| -> Vec<f64> {
        whole.variable(name).expect(name).values.to_real().iter().copied().collect()
    };
    let (outcomes, periods, sizes) = (of("outcome"), of("period"), of("size"));
    let [x, v] = ["section_x", "section_v"].map(of);
    let [mut free, mut from_rest] = [0, 0];
    for index in 0..study.cases() {
        if outcomes[index] != f64::from(Outcome::Periodic as u8) || periods[index] != 1.0 {
            continue;
        }
        let case = study.case(index);
        // From rest, and by the engine alone, the same orbit is met or another.
        let (Impactor { c, f, w, wall, .. }, orbit) = settled(&case, &study.protocol);
        let [x, v] = [x[8 * index], v[8 * index]];
        // The answer without a wall, which is the motion where it stays below the wall; beside it there may be one with impacts.
        let size = (1.0 - w * w).powi(2) + (c * w).powi(2);
        let exact = [f * (1.0 - w * w) / size, f * c * w * w / size];
        let is_free = (x - exact[0]).abs().max((v - exact[1]).abs()) < 1e-9;
        let point = [x, v].into();
        let known = IMPACT.stable_orbit(&Setting::of(&case), &point, 1, 1e-12).expect("an orbit");
        assert_eq!(known.impacts == 0, is_free && f / size.sqrt() < wall, "case {index}");
        free += usize::from(is_free);
        if orbit.period == 1 && (orbit.section[0][0] - x).abs() < 1e-6 {
            assert!((orbit.size - sizes[index]).abs() < 1e-9 * sizes[index], "case {index}");
            from_rest += usize::from(!is_free);
        }
    }
    assert!(free > 50 && from_rest > 50, "{free} {from_rest}");
    // Where the mass only just reaches the wall, orbits without impacts end: at the amplitude.
    let kinds = whole.variable("special_kind").expect("special points");
    let grazing = kinds.flags.iter().find(|(_, name)| name == "grazing").expect("a kind").0;
    let walls = of("special_wall");
    let exact = 1.0 / f64::hypot(1.0 - 1.5 * 1.5, 0.1 * 1.5);
    let grazings =
        kinds.values.to_real().into_iter().zip(walls).filter(|it| it.0 == grazing as f64);
    let nearest = grazings.map(|it| (it.1 - exact).abs()).fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-9, "{nearest:e} {kinds:?}");
}

#[test]
fn what_is_stopped_and_resumed_has_the_bytes_of_one_run() {
    let study = study(STARTS);
    let (_folder, output) = place();
    let campaign = Campaign::new(&study, &output);
    let stopped = campaign.run(Task::WHOLE, &after(700, |it| matches!(it, Event::Case { .. })));
    stopped.expect_err("it was stopped");
    let kept = campaign.status().expect("a status").blocks.expect("a folder").done.len();
    assert!((1..4).contains(&kept), "{kept}");
    campaign.run(Task::WHOLE, &|_| ControlFlow::Continue(())).expect("the rest");
    assert!(timeless(&output) == uninterrupted(&study), "the bytes differ");
}

#[test]
fn its_basins_branches_and_diagrams_are_drawn() {
    let (_folder, archive) = swept(STARTS);
    let whole = archive.dataset(|_, _| true).expect("it reads back");
    let shares: Vec<f64> =
        whole.variable("attractor_share").expect("shares").values.to_real().into_iter().collect();
    assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-9 && shares.len() > 1, "{shares:?}");
    // Distances are told as the model compares its section points, without a unit where they have none.
    let ball = whole.variable("attractor_integrity_factor").expect("the room of the basins");
    assert_eq!(ball.unit, "1");
    assert!(ball.long_name.ends_with("by w x and v"), "{}", ball.long_name);
    let place = folder("other_models");
    draw(&whole, &drawing("basin", DrawingKind::Basin), &into(&place, &ALL)).expect("a figure");
    let (_folder, archive) = swept(LINE);
    let whole = archive.dataset(|_, _| true).expect("it reads back");
    let line = drawing("line", DrawingKind::Bifurcation);
    let line = Drawing { branches: true, at: [("c".to_owned(), 0.1)].into(), ..line };
    draw(&whole, &line, &into(&place, &ALL)).expect("a figure");
    draw(&whole, &drawing("map", DrawingKind::Map), &into(&place, &ALL)).expect("a figure");
    let said = draw(&whole, &drawing("trade-off", DrawingKind::TradeOff), &into(&place, &ALL));
    let said = said.expect_err("no outputs are named").to_string();
    assert!(
        said.contains("the model impact-oscillator names no gain and no cost of its own"),
        "{said}"
    );
}

#[test]
fn results_of_a_model_that_is_not_known_are_refused() {
    let (folder, archive) = swept(STARTS);
    let mut whole = archive.dataset(|_, _| true).expect("it reads back");
    whole.attributes.insert("model".to_owned(), "pendulum".to_owned());
    let path = folder.path().join("other.h5");
    // What is written is opened again, as any file is.
    let said = store::write(&whole, &path).expect_err("nobody knows it").to_string();
    assert!(!path.exists());
    assert!(said.contains("its results are of the model pendulum, which is not known"), "{said}");
}

#[test]
fn its_parameters_are_called_as_it_calls_them() {
    let names: Vec<&str> = IMPACT_OSCILLATOR.parameters().map(Parameter::symbol).collect();
    assert_eq!(names, ["c", "f", "w", "r", "wall"]);
}
