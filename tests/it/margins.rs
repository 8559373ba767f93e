//! `capsulemap tradeoff --margins`: continuation finds special points where a parameter may change no further.

use serde_json::Value;

use super::program::WorkDir;

/// The paper's capsule near a fold, and where it moves fast.
const STUDIES: [(&str, [&str; 2]); 2] = [
    (
        "k2 = \"100 kN/m\"\ndelta = \"0.22 mm\"\n",
        ["\"1.25 N\", \"1.26 N\"", "\"31.9 rad/s\", \"32 rad/s\""],
    ),
    ("k2 = \"20 kN/m\"\ndelta = \"3 mm\"\n", ["\"7 N\", \"7.2 N\"", "\"54 rad/s\", \"56 rad/s\""]),
];
/// The kinds of special points by their codes in files of results.
const KINDS: [&str; 5] = ["fold", "period doubling", "Neimark-Sacker", "grazing", "event sequence"];

fn number(point: &Value, key: &str) -> f64 {
    point[key].as_f64().unwrap_or_else(|| panic!("{key} in {point}"))
}

/// The special points along a parameter between two values, from the case of a point, as values and kinds.
fn specials(
    folder: &WorkDir,
    (held, point): (&str, &Value),
    (symbol, unit): (&str, &str),
    [low, high]: [f64; 2],
) -> Vec<(f64, &'static str)> {
    let value = |symbol: &str| number(&point["parameters"], symbol);
    let (other, other_unit) = if symbol == "p_d" { ("omega", "rad/s") } else { ("p_d", "N") };
    let study = format!(
        "[parameters]\n{held}{other} = \"{:?} {other_unit}\"\n\
         [[axes]]\nname = \"{symbol}\"\nfrom = \"{low:?} {unit}\"\nto = \"{high:?} {unit}\"\npoints = 3\n\
         [[branches]]\nname = \"along\"\nalong = \"{symbol}\"\nat = {{ {symbol} = \"{:?} {unit}\" }}\n",
        value(other),
        value(symbol)
    );
    folder.put("branch.toml", study);
    folder.run(&["continue", "branch.toml", "--overwrite"]).done();
    let file = hdf5::File::open(folder.path("results/branch/branch.h5")).expect("a file");
    let values = file.dataset(&format!("special_{symbol}")).and_then(|it| it.read_raw::<f64>());
    let kinds = file.dataset("special_kind").and_then(|it| it.read_raw::<i64>());
    let kinds = kinds.expect("kinds").into_iter().map(|code| KINDS[code as usize]);
    values.expect("values").into_iter().zip(kinds).collect()
}

#[test]
fn margins_end_where_continuation_finds_special_points() {
    let mut compared = 0;
    for (held, [forces, frequencies]) in STUDIES {
        let folder = WorkDir::new();
        folder.put(
            "study.toml",
            format!(
                "[parameters]\n{held}[[axes]]\nname = \"p_d\"\nvalues = [{forces}]\n\
                 [[axes]]\nname = \"omega\"\nvalues = [{frequencies}]\n"
            ),
        );
        folder.run(&["sweep", "study.toml"]).done();
        let asked = ["tradeoff", "results/study/study.h5", "--margins", "--json"];
        let answer = folder.run(&asked).json();
        let point = &answer["fastest"];
        for (symbol, unit) in [("p_d", "N"), ("omega", "rad/s")] {
            let margins = &point["margins"][symbol];
            let here = number(&point["parameters"], symbol);
            let [down, up] = ["down", "up"].map(|side| &margins[side]);
            assert!(number(down, "value") < here && here < number(up, "value"), "{margins}");
            for margin in [down, up] {
                let Some(what) = margin["what"].as_str() else {
                    let share = number(margin, "value") / here;
                    assert!([0.5, 1.5].iter().any(|it| (share - it).abs() < 1e-9), "{margin}");
                    continue;
                };
                let value = number(margin, "value");
                let beyond = 0.1 * (value - here);
                let mut ends = [here - beyond, value + beyond];
                ends.sort_by(f64::total_cmp);
                let found = specials(&folder, (held, point), (symbol, unit), ends);
                let is_it = |(special, kind): &(f64, &str)| {
                    (special - value).abs() <= 1e-6 * here && *kind == what
                };
                assert!(found.iter().any(is_it), "{symbol} {margin}: {found:?}");
                compared += 1;
            }
        }
    }
    assert!(compared >= 4, "{compared}");
}
