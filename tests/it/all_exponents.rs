//! All Lyapunov exponents and the dimension through the program: in answers, files and figures, and only where they are asked for.

use capsulemap::store;
use serde_json::Value;

use super::program::{FIG5, WorkDir};

/// Duffing's oscillator with two wells (Moon and Holmes 1979).
const TWO_WELLS: &str = "[system]
name = \"Duffing oscillator with two wells\"
states = { x = \"1\", v = \"1\" }
section = { every = \"2*pi\" }
[system.parameters]
c = 0.2
p = 0.3
[system.rates]
x = \"v\"
v = \"p*cos(t) - c*v + x - x^3\"
";

fn number(told: &Value, key: &str) -> f64 {
    told[key].as_f64().unwrap_or_else(|| panic!("no number {key}: {told}"))
}

#[test]
fn a_case_tells_all_exponents_where_they_are_asked_for() {
    let work = WorkDir::new();
    work.put("wells.toml", TWO_WELLS);
    let case =
        ["simulate", "--system", "wells.toml", "--start", "x=0.1,v=0.1", "--max-cycles", "100"];
    let told = work.run(&[&case[..], &["--exponents", "all", "--json"]].concat()).json();
    let orbit = &told["orbit"];
    assert_eq!(orbit["outcome"], "chaotic");
    let [first, second] = ["lyapunov_1", "lyapunov_2"].map(|it| number(orbit, it));
    let error = number(orbit, "lyapunov_1_error");
    assert!((first - 0.159).abs() < 0.001 + 4.0 * error, "{first} {error}");
    assert!((first + second + 0.2).abs() < 1e-9, "{first} {second}");
    let dimension = number(orbit, "kaplan_yorke_dimension");
    assert!((dimension - 1.0 - first / -second).abs() < 1e-9, "{dimension}");
    assert!(number(orbit, "kaplan_yorke_dimension_error") < 0.1);
    let text = work.run(&[&case[..], &["--exponents", "all"]].concat()).done().out;
    assert!(text.contains("lyapunov_2 ") && text.contains("kaplan_yorke_dimension "), "{text}");
    let usual = work.run(&case).done().out;
    assert!(!usual.contains("lyapunov_2") && !usual.contains("kaplan"), "{usual}");
}

/// The paper's capsule where it sticks, and where it only slides.
fn study(protocol: &str) -> String {
    let axis = "[[axes]]\nname = \"omega\"\nfrom = \"60 rad/s\"\nto = \"80 rad/s\"\npoints = 3\n";
    format!("{FIG5}{axis}[protocol]\n{protocol}").replace("omega = \"77.91 rad/s\"\n", "")
}

#[test]
fn files_and_figures_have_all_exponents_where_they_are_asked_for() {
    let work = WorkDir::new();
    let figure = "[[figures]]\nname = \"second\"\nkind = \"bifurcation\"\nx = \"omega\"\nof = [\"lyapunov_2\"]\n";
    work.put("all.toml", study("exponents = \"all\"\n") + figure);
    work.put("usual.toml", study(""));
    for name in ["all", "usual"] {
        work.run(&["sweep", &format!("{name}.toml"), "--output", &format!("{name}.h5")]).done();
    }
    let [all, usual] =
        ["all.h5", "usual.h5"].map(|it| store::read(&work.path(it)).expect("a file"));
    let column = |name: &str| -> Vec<f64> {
        all.variable(name).expect(name).values.to_real().into_iter().collect()
    };
    assert_eq!(column("lyapunov_1"), column("lyapunov_exponent"));
    assert!(column("lyapunov_2").iter().all(|it| *it < 0.0 && it.is_finite()));
    // Sticking takes a direction out of the motion.
    assert!(column("lyapunov_3").contains(&f64::NEG_INFINITY));
    assert_eq!(column("kaplan_yorke_dimension"), [0.0; 3]);
    assert_eq!(all.variable("lyapunov_3").expect("it").unit, "1/s");
    assert!(
        usual.variable("lyapunov_2").is_none()
            && !usual.attributes.contains_key("protocol_exponents")
    );
    assert_eq!(all.attributes["protocol_exponents"], "all");
    for (name, variable) in &usual.variables {
        let same = all.variable(name).expect(name);
        assert_eq!(format!("{:?}", same.values), format!("{:?}", variable.values), "{name}");
    }
    assert!(work.files().iter().any(|it| it.contains("second")), "{:?}", work.files());
    work.run(&["verify", "all.h5"]).done();
}

#[test]
fn what_does_not_fit_all_exponents_is_refused() {
    let work = WorkDir::new();
    work.put("wells.toml", TWO_WELLS);
    let axis = "[[axes]]\nname = \"c\"\nfrom = 0.2\nto = 0.3\npoints = 2\n";
    for (text, parts) in [
        (
            format!("outputs = [\"lyapunov_2\"]\n{}", study("")),
            &["outputs", "is computed where [protocol] has exponents = \"all\""][..],
        ),
        (study("exponents = \"some\"\n"), &["protocol.exponents", "largest, all"]),
        (
            study("exponents = \"all\"\nexponent_cycles = 0\n"),
            &["protocol.exponents", "exponent_cycles = 0 leaves all exponents out"],
        ),
        (study("mean_error = 2\n"), &["protocol.mean_error", "must lie between 0.00001 and 0.5"]),
        (
            format!("system = \"wells.toml\"\n{axis}[protocol]\nmean_error = 0.1\n"),
            &["protocol.mean_error", "nothing drifts"],
        ),
    ] {
        work.put("s.toml", text);
        work.run(&["check", "s.toml"]).refused(parts);
    }
}
