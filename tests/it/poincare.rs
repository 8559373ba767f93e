//! The figure of Poincaré sections: every point that a case keeps, at the stroboscopic section and at the impacts.

use capsulemap::store;

use super::program::WorkDir;

/// The chaotic capsule of studies/chaos.toml, and the same driven twice as fast.
fn study(points: usize) -> String {
    format!(
        "[parameters]\nk2 = \"60 kN/m\"\nc = \"0.2 N s/m\"\nmu_s = 0.3\nmu_d = 0.25\ndelta = \"2 mm\"\np_d = \"5 N\"\n\
         [[axes]]\nname = \"omega\"\nvalues = [\"30 rad/s\", \"15 rad/s\"]\n\
         [protocol]\npoints = {points}\nimpact_points = {points}\nmeasured_cycles = 50\n\
         [[figures]]\nname = \"section\"\nkind = \"section\"\nat = {{ omega = \"15 rad/s\" }}\n"
    )
}

#[test]
fn every_kept_point_of_the_held_case_is_drawn() {
    let folder = WorkDir::new();
    folder.put("study.toml", study(40));
    folder.run(&["sweep", "study.toml", "--formats", "svg"]).done();
    let dataset = store::read(&folder.path("results/study/study.h5")).expect("a file of results");
    let finite = |name: &str| {
        let values = dataset.variable(name).expect("it is kept").values.to_real();
        values.into_iter().skip(40).filter(|it| it.is_finite()).count()
    };
    let (section, impacts) = (finite("section_r"), finite("impact_phase"));
    assert!(section == 40 && impacts > 20, "{section} {impacts}");
    let picture =
        std::fs::read_to_string(folder.path("results/study/section.svg")).expect("a picture");
    assert!(picture.contains(&format!("{section} stroboscopic section points")), "{section}");
    assert!(picture.contains(&format!("{impacts} kept impacts")), "{impacts}");
}

#[test]
fn sections_need_points_that_are_kept() {
    let folder = WorkDir::new();
    folder.put("study.toml", study(0));
    let ran = folder.run(&["sweep", "study.toml"]);
    ran.refused(&["there are no section points", "`points` of [protocol]"]);
    assert_eq!(folder.files(), ["study.toml"]);
}
