//! Outputs that a study defines: their values and derivatives beside another evaluation, their units, and what is refused.

use capsulemap_models::capsule::description::CAPSULE;
use capsulemap_models::description::{Description, Outputs, Parameters};
use capsulemap_text::own::with_own;

use super::draws::Random;

fn defined(lines: &str) -> &'static Description {
    let text = format!("title = \"own\"\n[outputs.own]\n{lines}\n");
    with_own(&CAPSULE, &text).unwrap_or_else(|faults| panic!("{text}\n{faults:?}"))
}

/// The faults of these lines, which begin at line 3, each in words.
fn faults(lines: &str) -> Vec<String> {
    let text = format!("title = \"own\"\n[outputs.own]\n{lines}\n");
    let found = with_own(&CAPSULE, &text).expect_err(&text);
    found.iter().map(ToString::to_string).collect()
}

/// Values of parameters and outputs of the capsule, all above zero.
fn drawn(random: &mut Random) -> (Parameters, Outputs) {
    let mut parameters = Parameters::of(&CAPSULE);
    for parameter in CAPSULE.parameters().take(6) {
        parameters[parameter] = random.uniform(0.5, 2.0);
    }
    let outputs: Vec<f64> = CAPSULE.outputs().map(|_| random.uniform(0.5, 2.0)).collect();
    (parameters, Outputs::new(&CAPSULE, &outputs))
}

/// What an expression is at some values.
type Value = Box<dyn Fn(&Parameters, &Outputs) -> f64>;

/// A random expression of plain numbers as text, and what it is by the arithmetic of Rust.
fn random_expression(random: &mut Random, depth: usize) -> (String, Value) {
    let pick = (random.uniform(0.0, 1.0) * 10.0) as usize;
    if depth == 0 || pick < 2 {
        return leaf(random);
    }
    let (a, of_a) = random_expression(random, depth - 1);
    match pick {
        2 => (format!("-({a})"), Box::new(move |p, o| -of_a(p, o))),
        3 => (format!("sqrt(abs({a}))"), Box::new(move |p, o| of_a(p, o).abs().sqrt())),
        4 => (format!("sin({a}) + tanh({a})"), {
            Box::new(move |p, o| of_a(p, o).sin() + of_a(p, o).tanh())
        }),
        5 => (format!("({a})**2"), Box::new(move |p, o| of_a(p, o).powi(2))),
        6 => (format!("exp(-abs({a}))"), Box::new(move |p, o| (-of_a(p, o).abs()).exp())),
        _ => {
            let (b, of_b) = random_expression(random, depth - 1);
            match pick {
                7 => (format!("({a}) + {b}"), Box::new(move |p, o| of_a(p, o) + of_b(p, o))),
                8 => (format!("({a})*({b})"), Box::new(move |p, o| of_a(p, o) * of_b(p, o))),
                _ => (format!("({a})/(2 + abs({b}))"), {
                    Box::new(move |p, o| of_a(p, o) / (2.0 + of_b(p, o).abs()))
                }),
            }
        }
    }
}

/// A number, or a ratio of two outputs or parameters of one unit.
fn leaf(random: &mut Random) -> (String, Value) {
    let number = random.uniform(0.5, 2.0);
    match (random.uniform(0.0, 1.0) * 3.0) as usize {
        0 => (format!("{number:?}"), Box::new(move |_, _| number)),
        1 => ("m2/m1".into(), {
            let [a, b] = ["m2", "m1"].map(|it| CAPSULE.parameter(it).expect("a mass"));
            Box::new(move |p, _| p[a] / p[b])
        }),
        _ => ("work_net/friction_loss".into(), {
            let [a, b] = ["work_net", "friction_loss"].map(|it| CAPSULE.output(it).expect(it));
            Box::new(move |_, o| o[a] / o[b])
        }),
    }
}

#[test]
fn random_expressions_are_what_another_evaluation_has() {
    let mut random = Random::new(20);
    let step = 1e-6;
    let (mut with_slope, mut compared) = (0, 0);
    for _ in 0..300 {
        let (text, value) = random_expression(&mut random, 5);
        let model = defined(&format!("found = \"{text}\""));
        let own = model.output("found").expect("it is defined");
        assert_eq!(own.unit(), "1", "{text}");
        let (parameters, outputs) = drawn(&mut random);
        let with_parameters = parameters.of_extension(model);
        let found = outputs.with_own(&with_parameters)[own];
        let expected = value(&parameters, &outputs);
        assert!(
            (found - expected).abs() <= 1e-13 * (1.0 + expected.abs()),
            "{text}: {found} {expected}"
        );
        // Along m1, and along directions of the outputs that go with it.
        let m1 = CAPSULE.parameter("m1").expect("a mass");
        let rates: Vec<f64> = CAPSULE.outputs().map(|_| random.uniform(-1.0, 1.0)).collect();
        let moved = |by: f64| {
            let mut there = parameters.clone();
            there[m1] += by;
            let at = outputs.each().zip(&rates).map(|((_, it), rate)| it + by * rate);
            value(&there, &Outputs::new(&CAPSULE, &at.collect::<Vec<_>>()))
        };
        let [near, far] = [step, 2.0 * step].map(|by| (moved(by) - moved(-by)) / (2.0 * by));
        let slopes = Outputs::new(&CAPSULE, &rates);
        let slope = slopes.slopes_with_own(&with_parameters, &outputs, m1)[own];
        // Where differences of two steps disagree, a kink lies between.
        if (near - far).abs() < 1e-6 * (1.0 + near.abs()) {
            compared += 1;
            with_slope += usize::from(slope != 0.0);
            assert!((slope - near).abs() < 1e-5 * (1.0 + near.abs()), "{text}: {slope} {near}");
        }
    }
    assert!(compared > 280 && with_slope > 150, "{compared} {with_slope}");
}

#[test]
fn units_follow_from_those_of_outputs_and_parameters() {
    for (written, unit) in [
        ("\"progression_speed/power\"", "m/J"),
        ("\"power/progression_speed\"", "N"),
        ("\"progression_speed*power\"", "W m/s"),
        ("\"power/omega\"", "J"),
        ("\"progression_speed\"", "m/s"),
        ("\"work_positive/work_net\"", "1"),
        ("\"sqrt(delta*delta)\"", "m"),
        ("\"delta^3\"", "m3"),
        ("\"p_d/m1\"", "m/s2"),
        ("\"power + 2*mW\"", "W"),
        ("\"max(power, 0)\"", "W"),
        ("\"omega/(2*pi)\"", "1/s"),
        ("{ value = \"omega\", unit = \"Hz\" }", "Hz"),
        ("{ value = \"progression_speed/power\", unit = \"mm/mJ\" }", "mm/mJ"),
        ("{ value = \"delta*p_d\", unit = \"N m\" }", "N m"),
    ] {
        let own = defined(&format!("it = {written}")).output("it").expect("it is defined");
        assert_eq!(own.unit(), unit, "{written}");
    }
}

#[test]
fn values_are_in_the_units_that_are_given() {
    let mut random = Random::new(21);
    let (mut parameters, outputs) = drawn(&mut random);
    let model = defined(
        "hertz = { value = \"omega\", unit = \"Hz\" }\n\
         far = { value = \"delta + 3*mm\", unit = \"mm\" }\n\
         twice = \"2*far\"\n\
         more = \"delta - far\"\n\
         angle = \"sin(90*deg)\"\n\
         speed = \"progression_speed\"",
    );
    let [omega, delta] = ["omega", "delta"].map(|it| CAPSULE.parameter(it).expect(it));
    parameters[omega] = 100.0;
    parameters[delta] = 2e-3;
    let all = outputs.with_own(&parameters.of_extension(model));
    let value = |name: &str| all[model.output(name).expect(name)];
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14 * (1.0 + b.abs()), "{a} {b}");
    close(value("hertz"), 100.0 / std::f64::consts::TAU);
    close(value("far"), 5.0);
    close(value("twice"), 10e-3);
    close(value("more"), -3e-3);
    close(value("angle"), 1.0);
    assert_eq!(value("speed"), value("progression_speed"));
}

#[test]
fn own_outputs_use_each_other_in_any_order() {
    let mut random = Random::new(22);
    let (parameters, outputs) = drawn(&mut random);
    let model = defined("w = \"u*v\"\nu = \"work_net/v\"\nv = \"2*friction_loss\"");
    assert_eq!(model.own_outputs().map(|it| it.name()).collect::<Vec<_>>(), ["w", "u", "v"]);
    let all = outputs.with_own(&parameters.of_extension(model));
    let value = |name: &str| all[model.output(name).expect(name)];
    assert_eq!(value("v"), 2.0 * value("friction_loss"));
    assert_eq!(value("u"), value("work_net") / value("v"));
    assert_eq!(value("w"), value("u") * value("v"));
    // Where nothing is known of a motion, nothing is of what would follow without it.
    let model = defined("alone = \"2*delta\"");
    let none = Outputs::unknown(&CAPSULE).with_own(&parameters.of_extension(model));
    assert!(none[model.output("alone").expect("it is defined")].is_nan());
}

#[test]
fn what_is_smooth_follows_from_its_parts() {
    for (written, is_smooth) in [
        ("abs(progression_speed)/power", true),
        ("delta*p_d", true),
        ("max(power, work_net*omega)", false),
        ("power/(1 + largest_multiplier)", false),
    ] {
        let own = defined(&format!("it = \"{written}\"")).output("it").expect("it is defined");
        assert_eq!(own.is_smooth(), is_smooth, "{written}");
    }
}

#[test]
fn each_fault_is_told_with_its_place() {
    for (lines, places, parts) in [
        ("it = \"delta + omega\"", "line 3, column 15", vec!["m and 1/s cannot be added"]),
        ("it = \"power + 2\"", "line 3, column 15", vec!["W and a plain number cannot be added"]),
        ("it = \"max(power, delta)\"", "line 3, column 18", vec!["cannot be compared"]),
        (
            "it = \"progresion_speed/power\"",
            "line 3, column 7",
            vec!["did you mean \"progression_speed\"?"],
        ),
        ("it = \"power power\"", "line 3, column 13", vec!["expected an operator"]),
        ("it = \"power/\"", "line 3, column 13", vec!["expected a number, a name or ("]),
        ("it = \"exp(power)\"", "line 3, column 11", vec!["what exp is of", "not W"]),
        (
            "it = \"power^delta\"",
            "line 3, column 13",
            vec!["raised to a power that is no number", "not W"],
        ),
        ("it = \"sine(1)\"", "line 3, column 7", vec!["no function \"sine\"", "sin"]),
        ("it = \"max(1)\"", "line 3, column 7", vec!["max is of 2 values, not of 1"]),
        ("it = \"it + 1\"", "line 3, column 1", vec!["it is defined by itself"]),
        (
            "u = \"v\"\nv = \"2*w\"\nw = \"u/v\"",
            "line 3, column 1",
            vec!["defined in a circle: u, v, w, u"],
        ),
        (
            "power = \"2*delta\"",
            "line 3, column 1",
            vec!["the model capsule has something called \"power\""],
        ),
        ("k2 = \"2*delta\"", "line 3, column 1", vec!["has something called \"k2\""]),
        (
            "section_y1 = \"2*delta\"",
            "line 3, column 1",
            vec!["has something called \"section_y1\""],
        ),
        ("drive = \"2*delta\"", "line 3, column 1", vec!["has something called \"drive\""]),
        ("sin = \"2*delta\"", "line 3, column 1", vec!["has a meaning in every expression"]),
        ("\"two words\" = \"2*delta\"", "line 3, column 1", vec!["is no name"]),
        ("it = { value = \"power\", unit = \"m\" }", "line 3, column 17", vec!["it is W, not m"]),
        ("it = { unit = \"m\" }", "line 3, column 1", vec!["it needs `value`"]),
        (
            "it = { value = \"power\", units = \"W\" }",
            "line 3, column 25",
            vec!["no key \"units\"", "did you mean \"unit\"?"],
        ),
        (
            "it = { value = \"power\", meaning = \"a\\nb\" }",
            "line 3, column 36",
            vec!["must be one line"],
        ),
        ("it = [1]", "line 3, column 6", vec!["must be an expression in quotes, or a number"]),
    ] {
        let found = faults(lines).join("\n");
        assert!(found.contains(places), "{lines}\n{found}");
        for part in parts {
            assert!(found.contains(part), "{lines}\n{part}\n{found}");
        }
    }
    // All at once, and what follows from a fault is told once.
    let all = faults("u = \"delta + omega\"\nv = \"u + nothing\"\nw = \"2*v\"\nx = \"x\"");
    assert_eq!(all.len(), 3, "{all:?}");
    let many: String = (0..101).map(|it| format!("o{it} = \"power\"\n")).collect();
    assert!(faults(&many)[0].contains("more than 100 own outputs"));
    let deep = format!("it = \"{}1{}\"", "(".repeat(300), ")".repeat(300));
    assert!(faults(&deep)[0].contains("within each other"));
    let long = format!("it = \"1{}\"", " + 1".repeat(600));
    assert!(faults(&long)[0].contains("more than 1000"));
}
