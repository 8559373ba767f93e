//! Figures of synthetic results: every kind, the awkward cases, and what the files must hold.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use capsulemap::figure::{Format, Place, draw};
use capsulemap::store::dataset::Dataset;
use capsulemap::study::{Drawing, DrawingKind};

pub mod fixtures;

use fixtures::{Fixture, OUTCOMES, cascade, plane, steps, with_history};

/// Every format.
pub const ALL: [Format; 3] = [Format::Png, Format::Svg, Format::Pdf];

/// A folder for the figures of one test, kept in the build folder to be looked at.
pub fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("figures").join(name)
}

/// A place for figures, whatever is there already.
pub fn into<'a>(folder: &'a Path, formats: &'a [Format]) -> Place<'a> {
    Place { folder, formats, overwrite: true }
}

/// A request for a figure of this kind, all else as usual.
pub fn drawing(name: &str, kind: DrawingKind) -> Drawing {
    Drawing::new(name, kind)
}

/// A trade-off of the speed and the work of a cycle.
pub fn by_work(name: &str) -> Drawing {
    Drawing { of: vec!["work_positive".to_owned()], ..drawing(name, DrawingKind::TradeOff) }
}

#[test]
fn every_kind_comes_out_in_every_format() {
    let folder = folder("kinds");
    let single = with_history(Fixture::default().real("omega", &[], |_| 20.73), &[], 6.0, 3000).0;
    let axis = Fixture::default().coordinate("omega", "rad/s", vec![26.58, 37.33, 46.0, 54.6]);
    let four = with_history(axis, &["omega"], 10.0, 3000).0;
    let plane = plane(101, 61);
    let of = |name, kind, of: &str| Drawing { of: vec![of.to_string()], ..drawing(name, kind) };
    let up_and_down = Drawing {
        title: Some("Following the attractor up and down in frequency".to_string()),
        ..drawing("bifurcation-directions", DrawingKind::Bifurcation)
    };
    let requests = [
        (&single, drawing("history", DrawingKind::History)),
        (&four, drawing("history-four", DrawingKind::History)),
        (&single, drawing("portrait", DrawingKind::PhasePortrait)),
        (&cascade(300, 40, false), drawing("bifurcation", DrawingKind::Bifurcation)),
        (&cascade(120, 8, true), up_and_down),
        (&plane, drawing("map-speed", DrawingKind::Map)),
        (&plane, of("map-period", DrawingKind::Map, "period")),
        (&plane, of("map-outcome", DrawingKind::Map, "outcome")),
        (&plane, of("map-work", DrawingKind::Map, "work_positive")),
        (&plane, of("map-cost", DrawingKind::Map, "cost_of_transport")),
        (&plane, of("trade-off", DrawingKind::TradeOff, "work_positive")),
        (&plane, of("trade-off-maps", DrawingKind::TradeOffMaps, "work_positive")),
    ];
    for (dataset, request) in requests {
        let paths = draw(dataset, &request, &into(&folder, &ALL)).unwrap().paths;
        let starts: [&[u8]; 3] = [b"\x89PNG", b"<svg", b"%PDF"];
        for (path, start) in paths.iter().zip(starts) {
            assert!(fs::read(path).unwrap().starts_with(start), "{}", path.display());
        }
    }
}

/// The bytes of each file, drawn twice.
fn drawn_twice(dataset: &Dataset, request: &Drawing, place: &str) -> [Vec<Vec<u8>>; 2] {
    ["first", "second"].map(|turn| {
        let paths = draw(dataset, request, &into(&folder(place).join(turn), &ALL)).unwrap().paths;
        paths.iter().map(|path| fs::read(path).unwrap()).collect()
    })
}

#[test]
fn the_same_results_give_the_same_bytes() {
    let single = with_history(Fixture::default().real("omega", &[], |_| 20.73), &[], 4.0, 500).0;
    let [first, second] = drawn_twice(&single, &drawing("a", DrawingKind::PhasePortrait), "same");
    assert!(first == second);
    let [first, second] = drawn_twice(&plane(31, 21), &by_work("b"), "same");
    assert!(first == second);
    let cloud = cascade(400, 60, false);
    let [first, second] = drawn_twice(&cloud, &drawing("c", DrawingKind::Bifurcation), "same");
    assert!(first == second);
}

#[test]
fn only_whole_files_are_left_behind() {
    let folder = folder("whole");
    // The folder outlives the run of the test.
    let _ = fs::remove_dir_all(&folder);
    draw(&plane(9, 7), &drawing("map", DrawingKind::Map), &into(&folder, &ALL)).unwrap();
    let mut names: Vec<_> =
        fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["map.pdf", "map.png", "map.svg"]);
}

/// Position of a chunk's data in a PNG file.
fn chunk(png: &[u8], name: &[u8; 4]) -> usize {
    png.windows(4).position(|window| window == name).unwrap() + 4
}

#[test]
fn a_png_tells_its_size_on_paper() {
    let request = Drawing { width_mm: Some(100.0), ..drawing("paper", DrawingKind::Map) };
    let paths =
        draw(&plane(9, 7), &request, &into(&folder("paper"), &[Format::Png])).unwrap().paths;
    let png = fs::read(&paths[0]).unwrap();
    let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
    let (pixels, per_metre) = (number(chunk(&png, b"IHDR")), number(chunk(&png, b"pHYs")));
    assert!(per_metre >= 11811, "less than 300 dots per inch");
    assert!((f64::from(pixels) / f64::from(per_metre) - 0.1).abs() < 1e-4);
}

#[test]
fn maps_keep_the_edges_of_their_cells() {
    let request = Drawing { of: vec!["period".into()], ..drawing("edges", DrawingKind::Map) };
    let paths = draw(&plane(12, 9), &request, &into(&folder("edges"), &ALL)).unwrap().paths;
    let svg = fs::read_to_string(&paths[1]).unwrap();
    assert!(svg.contains("image-rendering:pixelated"));
    assert!(!svg.contains("<text"), "text in the file needs a font that the reader may lack");
    let pdf = fs::read(&paths[2]).unwrap();
    assert!(!pdf.windows(17).any(|window| window == b"/Interpolate true"));
    // A colour of the map other than its own categories would be a blend of two cells.
    let mut reader =
        png::Decoder::new(std::io::Cursor::new(fs::read(&paths[0]).unwrap())).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let row = info.height as usize / 2 * info.line_size;
    let inside = info.width as usize * 3 * 2 / 10..info.width as usize * 3 * 5 / 10;
    let colours: std::collections::BTreeSet<&[u8]> =
        pixels[row..row + info.line_size][inside].chunks_exact(3).collect();
    assert!(colours.len() <= 6, "{colours:?}");
}

#[test]
fn awkward_results_are_drawn() {
    let folder = folder("awkward");
    let mut requests: Vec<(Dataset, Drawing)> = Vec::new();
    let bare = |fixture: Fixture| fixture.coordinate("point", "1", vec![0.0]);
    let sweep = |name: &str, omega: Vec<f64>, r: fn(f64) -> f64, speed: fn(f64) -> f64| {
        let values = omega.clone();
        let fixture = bare(Fixture::default().coordinate("omega", "rad/s", omega))
            .real("section_r", &["omega", "point"], |i| r(values[i[0]]))
            .real("progression_speed", &["omega"], |i| speed(values[i[0]]))
            .integer("outcome", &["omega"], &OUTCOMES, |_| 0);
        (fixture.0, drawing(name, DrawingKind::Bifurcation))
    };
    requests.push(sweep("constant", steps(10.0, 20.0, 30), |_| 1.5e-3, |_| 0.0));
    requests.push(sweep("missing", steps(10.0, 20.0, 30), |_| f64::NAN, |_| f64::NAN));
    requests.push(sweep("two", vec![10.0, 20.0], |w| w * 1e-4, |w| -w * 1e-3));
    requests.push(sweep("one", vec![10.0], |w| w * 1e-4, |w| -w * 1e-3));
    requests.push(sweep("tiny", steps(10.0, 20.0, 40), |w| w * 1e-12, |w| w * w * 1e-9));
    requests.push(sweep("huge", steps(1e6, 9e6, 40), |w| w, |w| w * w));
    requests.push(sweep(
        "narrow",
        steps(66.9, 66.90002, 40),
        |w| 1.5e-3 + 1e-9 * (1e6 * (w - 66.9)).sin(),
        |w| -1.23456 + 1e-7 * (w - 66.9) / 2e-5,
    ));
    let decades = steps(1.0, 4.0, 50).iter().map(|it| 10f64.powf(*it)).collect();
    requests.push(sweep("log", decades, |w| w.ln() * 1e-4, |w| 1.0 / w));
    let decade = steps(1.2, 1.9, 50).iter().map(|it| 10f64.powf(*it)).collect();
    requests.push(sweep("log-short", decade, |w| w.ln() * 1e-4, |w| 1.0 / w));
    let (dataset, request) = sweep("narrow-page", steps(10.0, 20.0, 30), |w| w * 1e-4, |w| w);
    let title =
        "A heading that is a good deal longer than the page is wide & holds <odd> \"signs\"";
    let request = Drawing { title: Some(title.into()), width_mm: Some(45.0), ..request };
    requests.push((dataset, request));
    requests.push((cascade(1000, 1000, false), drawing("million", DrawingKind::Bifurcation)));
    requests.push((cascade(1500, 100, true), drawing("dense-both", DrawingKind::Bifurcation)));

    let single = Fixture::default().real("work_positive", &[], |_| 5e-3).real(
        "progression_speed",
        &[],
        |_| 2e-3,
    );
    requests.push((single.0, by_work("trade-off-one")));
    let none = Fixture::default()
        .coordinate("omega", "rad/s", steps(1.0, 9.0, 5))
        .real("work_positive", &["omega"], |_| f64::NAN)
        .real("progression_speed", &["omega"], |_| f64::NAN);
    requests.push((none.0, by_work("trade-off-none")));

    let grid = |columns: usize, rows: usize, of: fn(&[usize]) -> f64| {
        Fixture::default()
            .coordinate("start_r", "m", steps(-2e-3, 2e-3, columns))
            .coordinate("start_y1", "m/s", steps(-0.4, 0.4, rows))
            .real("progression_speed", &["start_r", "start_y1"], of)
            .0
    };
    for (name, dataset) in [
        ("map-two", grid(2, 2, |i| (i[0] * 2 + i[1]) as f64 * 1e-3)),
        ("map-row", grid(9, 1, |i| i[0] as f64 * 1e-7)),
        ("map-constant", grid(9, 5, |_| 2e-3)),
        ("map-missing", grid(9, 5, |_| f64::NAN)),
        ("map-fine", grid(900, 700, |i| ((i[0] * i[1]) as f64 * 1e-3).sin() * 1e-3)),
    ] {
        requests.push((dataset, drawing(name, DrawingKind::Map)));
    }
    let mut basin = grid(160, 120, |_| 0.0);
    let mut kinds =
        Fixture(basin.clone()).integer("attractor", &["start_r", "start_y1"], &[], |i| {
            ((i[0] as f64 * 0.11).sin() * 8.0 + i[1] as f64 * 0.1).rem_euclid(3.0) as i64
        });
    basin = std::mem::take(&mut kinds.0);
    if let Some(it) = basin.variables.get_mut("attractor") {
        it.long_name = "attractor".into();
        it.flags = ["standing still", "forward", "backward"]
            .iter()
            .enumerate()
            .map(|(at, name)| (at as i64, name.to_string()))
            .collect();
    }
    let request = Drawing { of: vec!["attractor".into()], ..drawing("basin", DrawingKind::Map) };
    requests.push((basin, request));

    let counts = Fixture::default()
        .coordinate("delta", "m", steps(0.0, 5e-3, 60))
        .integer("impacts", &["delta"], &[], |i| (i[0] / 20) as i64)
        .real("acceleration_of_mass", &["delta"], |i| 10f64.powf(i[0] as f64 / 12.0));
    let mut counts = counts.0;
    if let Some(it) = counts.variables.get_mut("acceleration_of_mass") {
        it.long_name = "largest acceleration of the internal mass".into();
        it.unit = "m/s^2".into();
    }
    let of = vec!["impacts".to_string(), "acceleration_of_mass".to_string()];
    requests.push((counts, Drawing { of, ..drawing("counts", DrawingKind::Bifurcation) }));

    let long =
        with_history(Fixture::default().real("omega", &[], |_| 77.91), &[], 400.0, 200_000).0;
    let some = Drawing { cycles: Some([395.0, 400.0]), ..drawing("cut", DrawingKind::History) };
    requests.push((long.clone(), drawing("long-history", DrawingKind::History)));
    requests.push((long, some));
    let axis = Fixture::default().coordinate("k2", "N/m", vec![2420.0, 18960.0, 59410.0]);
    let three = with_history(axis.real("omega", &[], |_| 30.0), &["k2"], 5.0, 900).0;
    let of = ["history_x2", "history_r", "velocities"].map(String::from).to_vec();
    let wide = Drawing { width_mm: Some(180.0), of, ..drawing("grid", DrawingKind::History) };
    requests.push((three, wide));

    let single = with_history(Fixture::default().real("omega", &[], |_| 20.73), &[], 2.0, 300).0;
    let small = Drawing { width_mm: Some(45.0), ..drawing("small", DrawingKind::PhasePortrait) };
    requests.push((single, small));
    let uneven = vec![5.0, 1.0, 2.0, 30.0, 12.0];
    let cube = Fixture::default()
        .coordinate("p_d", "N", uneven)
        .coordinate("phase", "rad", steps(0.0, 6.0, 7))
        .coordinate("k2", "N/m", vec![1e3, 1e4, 1e5])
        .real("work_positive", &["p_d", "phase", "k2"], |i| 1e-6 * 10f64.powi(i[0] as i32))
        .real("progression_speed", &["p_d", "phase", "k2"], |i| {
            (i[0] * 10) as f64 * 1e-3 + i[1] as f64 * 1e-4 - i[2] as f64 * 2e-3
        })
        .integer("period", &["p_d", "phase", "k2"], &[], |i| (i[0] + 5 * i[1] % 12) as i64)
        .0;
    let x = Some("k2".to_string());
    let coloured = Drawing { x, ..by_work("trade-off-cube") };
    requests.push((cube.clone(), coloured));
    let at = BTreeMap::from([("k2".to_string(), 9e3)]);
    let of = vec!["period".to_string()];
    requests.push((cube.clone(), Drawing { of, at, ..drawing("map-uneven", DrawingKind::Map) }));
    let of = vec!["work_positive".to_string(), "period".to_string()];
    requests.push((cube, Drawing { of, ..drawing("uneven", DrawingKind::Bifurcation) }));

    let at = BTreeMap::from([("direction".to_string(), 1.0)]);
    let down = Drawing { at, ..drawing("downward", DrawingKind::Bifurcation) };
    requests.push((cascade(120, 8, true), down));
    for (dataset, request) in &requests {
        draw(dataset, request, &into(&folder, &ALL))
            .unwrap_or_else(|error| panic!("{}: {error}", request.name));
    }
}

/// What is said of a request that cannot be drawn.
fn complaint(dataset: &Dataset, request: Drawing) -> String {
    draw(dataset, &request, &into(&folder("refused"), &[Format::Svg])).unwrap_err().to_string()
}

#[test]
fn what_is_missing_is_named_with_what_is_there() {
    let plane = plane(5, 4);
    let map = || drawing("speed-map", DrawingKind::Map);
    let said = complaint(&plane, Drawing { of: vec!["progresion_speed".into()], ..map() });
    assert!(said.contains("speed-map") && said.contains("did you mean `progression_speed`?"));
    let said = complaint(&plane, Drawing { x: Some("omga".into()), ..map() });
    assert!(said.contains("no axis `omga`; did you mean `omega`? (there is: omega, k2)"), "{said}");
    let at = BTreeMap::from([("k2".to_string(), 1e4)]);
    let said = complaint(&plane, Drawing { at, ..map() });
    assert!(said.contains("needs two axes") && said.contains("only omega"), "{said}");
    let said = complaint(&plane, drawing("motion", DrawingKind::History));
    assert!(said.contains("history_time"), "{said}");
    let both = BTreeMap::from([("k2".to_string(), 1e4)]);
    let said = complaint(&plane, Drawing { x: Some("k2".into()), at: both, ..map() });
    assert!(said.contains("both drawn and held"), "{said}");
    let said = complaint(&plane, Drawing { name: "../escape".into(), ..map() });
    assert!(said.contains("stem of a file name"), "{said}");
    let said = complaint(&plane, Drawing { title: Some("速度".into()), ..map() });
    assert!(said.contains("no character `速` (U+901F)"), "{said}");
}

#[test]
fn axes_are_held_at_the_nearest_value() {
    let plane = plane(41, 21);
    let held = |k2: f64| {
        let at = BTreeMap::from([("k2".to_string(), k2)]);
        let of = vec!["progression_speed".to_string()];
        let request = Drawing { at, of, ..drawing("held", DrawingKind::Bifurcation) };
        let paths = draw(&plane, &request, &into(&folder("held"), &[Format::Svg])).unwrap().paths;
        fs::read_to_string(&paths[0]).unwrap()
    };
    assert!(held(1e4) == held(1.01e4));
    assert!(held(1e4) != held(5e4));
    assert!(held(1e4).contains("progression_speed over omega at k2 = 10 kN/m"));
    let asked = |k2: f64| {
        let at = BTreeMap::from([("k2".to_string(), k2)]);
        let of = vec!["progression_speed".to_string()];
        Drawing { at, of, ..drawing("asked", DrawingKind::Bifurcation) }
    };
    let notes = |k2: f64| draw(&plane, &asked(k2), &into(&folder("held"), &[])).unwrap().notes;
    assert_eq!(notes(1e4), Vec::<String>::new());
    let said = notes(1.01e4);
    assert_eq!(said, ["k2 = 10000 N/m is taken for 10100 N/m, the nearest"]);
    for outside in [1.0, 1e9, f64::NAN] {
        let said = draw(&plane, &asked(outside), &into(&folder("held"), &[])).expect_err("outside");
        assert!(said.to_string().contains("and its axis goes from"), "{said}");
    }
}

#[test]
fn an_svg_needs_no_fonts_to_show_what_the_png_shows() {
    use resvg::{tiny_skia, usvg};
    let request = Drawing { title: Some("Heading".into()), ..drawing("alike", DrawingKind::Map) };
    let paths = draw(&plane(30, 20), &request, &into(&folder("alike"), &ALL)).unwrap().paths;
    let svg = fs::read_to_string(&paths[1]).unwrap();
    // These options know no fonts at all.
    let tree = usvg::Tree::from_str(&svg, &usvg::Options::default()).unwrap();
    let png = tiny_skia::Pixmap::load_png(&paths[0]).unwrap();
    let mut shown = tiny_skia::Pixmap::new(png.width(), png.height()).unwrap();
    // The resolution of the PNG over that of lengths in an SVG.
    let scale = 600.0 / 96.0;
    let transform = tiny_skia::Transform::from_scale(scale, scale);
    resvg::render(&tree, transform, &mut shown.as_mut());
    let far = |(a, b): (&u8, &u8)| a.abs_diff(*b) > 60;
    let different = png.data().iter().zip(shown.data()).filter(|pair| far(*pair)).count();
    assert!(different * 500 < png.data().len(), "{different} of {}", png.data().len());
}

#[test]
fn a_pdf_embeds_its_fonts_and_no_time() {
    let request = Drawing { title: Some("Heading".into()), ..drawing("fonts", DrawingKind::Map) };
    let paths =
        draw(&plane(9, 7), &request, &into(&folder("fonts"), &[Format::Pdf])).unwrap().paths;
    let pdf = fs::read(&paths[0]).unwrap();
    let holds = |words: &[u8]| pdf.windows(words.len()).any(|window| window == words);
    assert!(holds(b"LibertinusSerif-Regular") && holds(b"LibertinusSerif-Italic"));
    assert!(!holds(b"CreationDate") && !holds(b"ModDate"));
}

#[test]
fn the_font_can_draw_the_label_of_every_quantity() {
    let parameters = "omega p_d k1 k2 delta m1 m2 c mu_s mu_d v_s g c1 c2 start_r start_y1 start_y2 \
                      phase start_phase section_phase";
    let outputs = "progression_speed progression_per_cycle work_net work_positive work_absolute \
                   work_actuator friction_loss damper_loss energy_residual momentum_residual \
                   cost_of_transport power energy_per_metre impacts_per_cycle forward_slips_per_cycle \
                   backward_slips_per_cycle reversals_per_cycle stick_share peak_contact_force \
                   grazing_margin section_r section_y1 section_y2 impact_phase impact_y1 impact_y2";
    for parameter in parameters.split_whitespace() {
        let mut fixture = Fixture::default().coordinate(parameter, "1", steps(1.0, 2.0, 4));
        for output in outputs.split_whitespace() {
            fixture = fixture.real(output, &[parameter], |index| index[0] as f64);
        }
        let of = outputs.split_whitespace().map(String::from).collect();
        let request = Drawing { of, ..drawing(parameter, DrawingKind::Bifurcation) };
        draw(&fixture.0, &request, &into(&folder("labels"), &[Format::Svg])).unwrap();
    }
}
