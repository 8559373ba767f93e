//! Branches through the motions of a line, as the page of `capsulemap explore` asks for them.

use serde_json::Value;

use super::explore_answers::TWO;
use super::explorer::Explorer;
use super::program::{TWO_MOTIONS, WorkDir};

/// The branches through the motions of a line pass all of its motions that repeat with the same period, which are simulated; and
/// the unstable orbits beside them come back to where they were.
#[test]
fn branches_of_a_line_pass_its_motions() {
    let work = WorkDir::new();
    work.put("two.toml", TWO_MOTIONS.replace("p_d = \"2.79 N\"\n", "") + TWO);
    work.run(&["sweep", "two.toml", "--output", "two.h5", "--no-figures"]).done();
    let explorer = Explorer::new(&work, &["two.h5"]);
    // From a motion of each of the two branches.
    let whole = "p_d=2.79&omega=150&to_omega=170&count=21&start=inherit";
    let lines = explorer.lines(&format!("/api/line?{whole}"));
    let first = &lines[1];
    let [r, y1, y2] = [0, 1, 2].map(|i| first["end"][i].as_f64().expect("a state"));
    let orbit = format!("orbit_start_r={r:?}&orbit_start_y1={y1:?}&orbit_start_y2={y2:?}");
    let period = first["period"].as_u64().expect("a period");
    let asked = format!("/api/branches?{whole}&{orbit}&period={period}&place=0");
    let told = explorer.lines(&asked);
    let branch = &told[0]["branches"][0];
    assert_eq!(branch["period"], period);
    let points = branch["points"].as_array().expect("points");
    let number = |it: &Value, name: &str| it[name].as_f64().unwrap_or(f64::NAN);
    let mut passed = 0;
    for value in lines[1..].iter().filter(|it| it["period"] == period) {
        let share = number(value, "share");
        let is_passed = points.windows(2).any(|pair| {
            let [from, to] = [&pair[0], &pair[1]];
            let [a, b] = [from, to].map(|it| number(it, "share"));
            let part = if a == b { 0.0 } else { (share - a) / (b - a) };
            let [low, high] = [from, to].map(|it| number(it, "progression_speed"));
            let speed = low + part * (high - low);
            (0.0..=1.0).contains(&part)
                && from["stable"] == true
                && (speed - number(value, "progression_speed")).abs() < 1e-4
        });
        passed += usize::from(is_passed);
    }
    let same = lines[1..].iter().filter(|it| it["period"] == period).count();
    // The line may leave the branch where that folds.
    assert!(passed > 3 && passed <= same, "{passed} of {same}");
    let special = branch["special"].as_array().expect("special points");
    assert!(special.iter().any(|it| it["words"] == "fold"), "{special:?}");
    assert!(points.iter().any(|it| it["stable"] == false));
    for (more, part) in [
        ("&to_p_d=2.8", "one parameter"),
        ("&place=21", "place: a whole number from 0 to 20"),
        ("&period=0", "period: a whole number from 1"),
    ] {
        let (name, _) = more[1..].split_once('=').expect("a name");
        let rest: Vec<&str> =
            asked.split('&').filter(|it| !it.starts_with(&format!("{name}="))).collect();
        let refused = explorer.get(&(rest.join("&") + more));
        assert_eq!(refused.status, 400, "{more}");
        assert!(refused.text().contains(part), "{more}: {}", refused.text());
    }
    let without = asked.replace(&format!("&orbit_start_y2={y2:?}"), "");
    assert!(explorer.get(&without).text().contains("orbit_start_y2: a coordinate of the orbit"));
}
