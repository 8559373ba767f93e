//! Campaigns without a terminal: stopped, resumed, shared, joined, verified and replayed by the library alone.

pub mod place;

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use capsulemap::campaign::{
    BranchesDone, Campaign, CampaignError, Cause, Differs, Done, Event, Replay, Sample, Stage,
    Task, block_path, output_path, probe, read_study, silent, study_of, verify,
};
use capsulemap::capsule::settle_case;
use capsulemap::run::{self, Machine, Record};
use capsulemap::store::{self, Values, has_branches, has_cases};

use super::interrupted_runs::{LINES, LONG_STUDY};
use super::program::CASES_AND_BRANCH;
use place::{after, long_study, names, parse, place, timeless, uninterrupted};

#[test]
fn what_is_stopped_resumed_shared_and_joined_has_the_bytes_of_one_run() {
    let study = long_study();
    let (_folder, output) = place();
    let machine = Machine { threads: Some(1), ..Machine::default() };
    let campaign = Campaign { machine, ..Campaign::new(&study, &output) };
    let status = campaign.status().expect("a status");
    assert!(status.blocks.is_none() && matches!(status.file, Ok(None)));

    let [first, second] = [1, 2].map(|number| Task { number, of: 2 });
    // Within the third block, whenever the first two are reported to be written.
    let stopped = campaign.run(first, &after(1100, |it| matches!(it, Event::Case { .. })));
    let error = stopped.expect_err("it was stopped");
    assert!(matches!(error, CampaignError::Stopped) && error.cause() == Cause::Listener);
    let blocks = campaign.status().expect("a status").blocks.expect("a folder");
    let kept = blocks.done.len();
    assert!((1..3).contains(&kept) && !blocks.is_busy && blocks.faults.is_empty());

    let ran = Mutex::new((0, 0, 0));
    let resumed = campaign.run(first, &|event| {
        let mut ran = ran.lock().expect("a lock");
        match event {
            Event::Surveyed(survey) => ran.0 = survey.kept.len(),
            Event::Case { .. } => ran.1 += 1,
            Event::Computed { cases, .. } => ran.2 = cases,
            _ => {}
        }
        ControlFlow::Continue(())
    });
    assert!(matches!(resumed, Ok(Done::Shared(folder)) if folder == block_path(&output)));
    assert_eq!(ran.into_inner().expect("a lock"), (kept, 512 * (3 - kept), 512 * (3 - kept)));

    let error = campaign.join(&silent).expect_err("half is missing");
    let CampaignError::Missing { blocks, .. } = &error else { panic!("{error}") };
    assert!(blocks.len() == 3 && error.cause() == Cause::Request);
    assert!(error.to_string().contains("3 blocks missing: "), "{error}");
    let partial = campaign.join_partial(&silent).expect("what there is");
    let outcomes = partial.archive.variable("outcome").expect("it is read").expect("outcomes");
    let missing = outcomes.values.to_real().iter().filter(|code| **code == -1.0).count();
    assert!(missing == 1536 && partial.path != output && !output.exists());

    assert!(matches!(campaign.run(second, &silent), Ok(Done::Shared(_))));
    let blocks = campaign.status().expect("a status").blocks.expect("a folder");
    assert_eq!((blocks.done.len(), blocks.cases(), blocks.makers.len()), (6, 3072, 1));
    assert!(blocks.bytes > 0 && blocks.pace(&study).is_some());
    let joined = campaign.join(&silent).expect("all is there");
    assert!(joined.path == output && joined.archive.has_cases());
    assert!(timeless(&output) == uninterrupted(&study), "the bytes differ");
    let status = campaign.status().expect("a status");
    let file = status.file.expect("a file of this study").expect("a file");
    assert!(status.blocks.is_none() && file.same_text && file.archive.has_cases());
}

#[test]
fn a_file_that_is_complete_stays() {
    let study = long_study();
    let (_folder, output) = place();
    let campaign = Campaign::new(&study, &output);
    campaign.run(Task::WHOLE, &silent).expect("the study runs");
    let bytes = fs::read(&output).expect("a result");
    let events = AtomicUsize::new(0);
    let report = |event: Event<'_>| {
        assert!(matches!(event, Event::Before { same_text: true }));
        events.fetch_add(1, Ordering::Relaxed);
        ControlFlow::Continue(())
    };
    assert!(matches!(campaign.run(Task::WHOLE, &report), Ok(Done::Complete(_))));
    campaign.join(&report).expect("it is there");
    assert_eq!(events.into_inner(), 2);
    assert!(fs::read(&output).expect("a result") == bytes);
    // Another study is refused, and replaced only where that is asked for.
    let other = parse(&study.text.replace("max_cycles = 300", "max_cycles = 301"));
    let campaign = Campaign::new(&other, &output);
    let error = campaign.run(Task::WHOLE, &silent).expect_err("another study");
    assert!(matches!(error, CampaignError::OtherResults { same_program: true, .. }), "{error}");
    assert_eq!(error.cause(), Cause::Request);
    assert!(fs::read(&output).expect("a result") == bytes);
    let campaign = Campaign { overwrite: true, ..campaign };
    campaign.run(Task::WHOLE, &silent).expect("it is replaced");
    assert!(campaign.kept().expect("a file").expect("a file of this study").same_text);
}

#[test]
fn a_join_that_is_stopped_leaves_the_blocks_and_nothing_else() {
    let study = parse(&LINES.replace("points = 40", "points = 10"));
    let (folder, output) = place();
    let campaign = Campaign::new(&study, &output);
    let stages =
        [Event::Step(Stage::Linking), Event::Begun(Stage::Writing, 0), Event::Step(Stage::Writing)];
    for (place, stage) in stages.into_iter().enumerate() {
        let is_it = |event: Event<'_>| match (event, stage) {
            (Event::Step(a), Event::Step(b)) | (Event::Begun(a, _), Event::Begun(b, _)) => a == b,
            _ => false,
        };
        let stopped = campaign.run(Task::WHOLE, &after(1, is_it));
        assert!(matches!(stopped, Err(CampaignError::Stopped)), "{place}");
        assert_eq!(names(folder.path()), ["a.blocks"], "{place}");
        let blocks = campaign.status().expect("a status").blocks.expect("a folder");
        assert_eq!(blocks.done.len(), study.blocks());
    }
    // Nothing is computed again after that.
    let no_case = |event: Event<'_>| {
        assert!(!matches!(event, Event::Case { .. }));
        ControlFlow::Continue(())
    };
    campaign.run(Task::WHOLE, &no_case).expect("it is joined");
    assert_eq!(names(folder.path()), ["a.h5"]);
    assert!(timeless(&output) == uninterrupted(&study), "the bytes differ");
}

#[test]
fn a_torn_block_is_reported_and_computed_again() {
    let study = long_study();
    let (_folder, output) = place();
    let campaign = Campaign::new(&study, &output);
    let all_but_joined =
        campaign.run(Task::WHOLE, &after(1, |it| matches!(it, Event::Joining { .. })));
    assert!(matches!(all_but_joined, Err(CampaignError::Stopped)));
    let block = block_path(&output).join("block-0000003");
    let bytes = fs::read(&block).expect("a block");
    fs::write(&block, &bytes[..bytes.len() / 2]).expect("it is cut");
    assert_eq!(campaign.status().expect("a status").blocks.expect("a folder").done.len(), 5);
    let again = Mutex::new((Vec::new(), 0));
    campaign
        .run(Task::WHOLE, &|event| {
            let mut again = again.lock().expect("a lock");
            match event {
                Event::Again { file, why } => again.0.push((file.to_owned(), why.to_string())),
                Event::Block(_) => again.1 += 1,
                _ => {}
            }
            ControlFlow::Continue(())
        })
        .expect("it is computed again");
    let (ran, blocks) = again.into_inner().expect("a lock");
    assert!(ran.len() == 1 && ran[0].0 == block && ran[0].1.contains("torn"), "{ran:?}");
    assert_eq!(blocks, 1);
    assert!(timeless(&output) == uninterrupted(&study), "the bytes differ");
}

#[test]
fn a_fault_of_the_machine_is_no_mistake_in_the_request() {
    let study = long_study();
    let (folder, output) = place();
    let campaign = Campaign::new(&study, &output);
    let blocks = block_path(&output);
    // The folder of the blocks goes away under the run.
    let error = campaign.run(Task::WHOLE, &|event| {
        if matches!(event, Event::Case { .. }) {
            let _ = fs::remove_dir_all(&blocks);
        }
        ControlFlow::Continue(())
    });
    let error = error.expect_err("no block can be kept");
    assert!(matches!(error, CampaignError::NotKept { blocks: [0, 6], .. }), "{error:?}");
    assert_eq!(error.cause(), Cause::Machine);
    // A block is there and cannot be read.
    campaign.run(Task { number: 1, of: 6 }, &silent).expect("a sixth");
    fs::create_dir(blocks.join("block-0000005")).expect("a folder for a block");
    let error = campaign.run(Task::WHOLE, &silent).expect_err("a folder is no block");
    assert!(matches!(error, CampaignError::Block { .. }), "{error:?}");
    assert_eq!(error.cause(), Cause::Machine);
    // A file is where the folder of the results would be.
    fs::write(folder.path().join("file"), "text").expect("a file");
    let inside = folder.path().join("file/a.h5");
    let error = Campaign::new(&study, &inside).run(Task::WHOLE, &silent).expect_err("no folder");
    assert!(matches!(error, CampaignError::NoFolder { .. }), "{error:?}");
    assert_eq!(error.cause(), Cause::Request);
    // Blocks of another study are not mixed with these.
    let other = parse(&study.text.replace("max_cycles = 300", "max_cycles = 301"));
    let error = Campaign::new(&other, &output).run(Task::WHOLE, &silent).expect_err("other blocks");
    assert_eq!(error.cause(), Cause::Request, "{error}");
}

#[test]
fn a_sample_of_a_file_is_compared_bit_for_bit() {
    let study = long_study();
    let (_folder, output) = place();
    Campaign::new(&study, &output).run(Task::WHOLE, &silent).expect("the study runs");
    let all = Sample { cases: usize::MAX, seed: 1 };
    let steps = AtomicUsize::new(0);
    let count = |event: Event<'_>| {
        let is_step = matches!(event, Event::Step(Stage::Repeating));
        steps.fetch_add(usize::from(is_step), Ordering::Relaxed);
        ControlFlow::Continue(())
    };
    let same = verify(&output, all, Machine::default(), &count).expect("it is verified");
    assert_eq!((same.cases, same.differences.len(), same.other_program), (3072, 0, None));
    assert!(same.numbers > 10 * 3072 && steps.into_inner() == 3072);
    let some = Sample { cases: 40, seed: 7 };
    let drawn = verify(&output, some, Machine::default(), &silent).expect("it is verified");
    assert_eq!(drawn.cases, 40);
    let stopped =
        verify(&output, all, Machine::default(), &after(5, |it| matches!(it, Event::Step(_))));
    assert!(matches!(stopped, Err(CampaignError::Stopped)));

    let mut dataset = store::read(&output).expect("a result");
    let speed = dataset.variables.get_mut("progression_speed").expect("a speed");
    let Values::Real(speeds) = &mut speed.values else { panic!("reals") };
    let right = speeds[[17, 5]];
    let wrong = f64::from_bits(right.to_bits() ^ 1);
    speeds[[17, 5]] = wrong;
    dataset.variables.remove("period").expect("a period");
    store::write(&dataset, &output).expect("it is written");
    let found = verify(&output, all, Machine::default(), &silent).expect("it is verified");
    let differs: Vec<Differs> = found.differences.iter().map(|it| it.differs).collect();
    let (case, kept, computed) = (17 * 128 + 5, wrong, right);
    assert_eq!(differs, [Differs::Missing, Differs::Number { case, kept, computed }]);
    assert_eq!(found.differences[1].variable, "progression_speed");
}

#[test]
fn a_case_is_replayed_from_where_it_started_to_the_same_bits() {
    let study = parse(LINES);
    let (_folder, output) = place();
    Campaign::new(&study, &output).run(Task::WHOLE, &silent).expect("the study runs");
    let records = Mutex::new(Vec::new());
    let keep = |record| records.lock().expect("a lock").push(record);
    run::run(&study, Machine::default(), keep).expect("the study runs");
    let mut records = records.into_inner().expect("a lock");
    records.sort_by_key(|record: &Record| record.index);
    // The study comes from its results, as a reader of the file has nothing else.
    let archive = store::open(&output).expect("a result");
    let study = study_of(&archive, &output).expect("the study in the file");
    // First and last of a line, upward and downward, and cases between.
    let mut inherited = 0;
    for index in [0, 1, 60 * 39, 60 * 39 + 1, 60 * 20 + 14, 60 * 21 + 15] {
        let replay = Replay::new(&study, index).expect("a case");
        let case = replay.as_run(Machine::default(), &silent).expect("it is computed");
        assert_eq!(case.start, records[index].start, "{index}");
        let orbit = settle_case(&case, replay.protocol());
        let (start, start_phase) = (case.start.clone(), case.start_phase);
        let again = Record { index, start, start_phase, orbit };
        assert_eq!(format!("{again:?}"), format!("{:?}", records[index]));
        let upward = index % 2 == 0;
        let place = if upward { index / 60 } else { 39 - index / 60 };
        assert_eq!(replay.cases_before(), place, "{index}");
        inherited += usize::from(case.start != replay.as_asked().start);
        for (name, column) in store::schema::columns(&study, &[again]).variables {
            let kept = archive.rows(&name, &[study.position(index)]).expect("it is read");
            let bits = |values: &Values| -> Vec<u64> {
                values.to_real().iter().map(|it| it.to_bits()).collect()
            };
            assert_eq!(bits(&kept[0]), bits(&column.values), "case {index}: {name}");
        }
    }
    assert_eq!(inherited, 4, "the other two come first in their lines");
    let error = Replay::new(&study, study.cases()).expect_err("no such case");
    assert!(matches!(error, CampaignError::NoCase { index: 2400, cases: 2400 }), "{error}");
}

#[test]
fn branches_join_the_cases_in_the_file() {
    let study = parse(CASES_AND_BRANCH);
    let (_folder, output) = place();
    let campaign = Campaign::new(&study, &output);
    let Ok(BranchesDone::Now { found, .. }) = campaign.continue_branches(&silent) else {
        panic!("the branch is continued")
    };
    assert!(found.continued.len() == 1 && found.continued[0].is_ok());
    campaign.run(Task::WHOLE, &silent).expect("the study runs");
    let dataset = store::read(&output).expect("a result");
    assert!(has_cases(&dataset) && has_branches(&dataset));
    assert!(matches!(campaign.continue_branches(&silent), Ok(BranchesDone::Before(_))));
    // Branches of a study with another text would be lost, and are kept.
    let other = parse(&study.text.replace("28 rad/s", "27 rad/s"));
    let campaign = Campaign { study: &other, ..campaign };
    let error = campaign.continue_branches(&silent).expect_err("other branches");
    assert!(matches!(error, CampaignError::OtherBranches { .. }), "{error}");
    let alone = parse(CASES_AND_BRANCH.split("[[branches]]").next().expect("a study"));
    let error = Campaign::new(&alone, &output).continue_branches(&silent).expect_err("no branches");
    assert!(matches!(error, CampaignError::NoBranches), "{error}");
}

#[test]
fn a_study_and_its_results_are_found_by_their_paths() {
    let (folder, output) = place();
    let path = folder.path().join("long.toml");
    fs::write(&path, LONG_STUDY).expect("a study");
    assert_eq!(read_study(&path).expect("a study").blocks(), 24);
    let default = output_path(&path, None).expect("a path");
    assert_eq!(default, Path::new("results/long/long.h5"));
    assert_eq!(output_path(&path, Some(&output)).expect("a path"), output);
    for wrong in [folder.path(), &path, &folder.path().join("a.blocks")] {
        let error = output_path(&path, Some(wrong)).expect_err("no place for results");
        assert_eq!(error.cause(), Cause::Request, "{error}");
    }
    fs::write(&path, b"title = \"a\"\n\xff").expect("no text");
    let error = read_study(&path).expect_err("no text");
    assert!(error.to_string().ends_with("line 2: is not text in UTF-8"), "{error}");
    let error = read_study(&output).expect_err("no file");
    assert!(error.to_string().contains("cannot be read"), "{error}");
}

#[test]
fn a_probe_tells_time_and_room_and_writes_nothing() {
    let study = long_study();
    let found = probe(&study, Machine::default(), Duration::from_secs(60), &silent);
    let found = found.expect("it is computed");
    // So short a study is over before the time.
    assert_eq!((found.cases, found.blocks), (3072, 6));
    let seconds = found.seconds.expect("a time");
    // What it takes to pack the blocks comes on top.
    assert!(seconds.value > found.time.as_secs_f64() && seconds.error == 0.0);
    assert!(found.bytes > 1e5 && found.bytes < 1e8, "{}", found.bytes);
    let part = probe(&study, Machine::default(), Duration::ZERO, &silent).expect("it is computed");
    assert!(part.cases < 3072, "{}", part.cases);
}

#[test]
fn a_study_that_is_not_as_its_text_says_is_not_run() {
    let (_folder, output) = place();
    let mut study = parse(CASES_AND_BRANCH);
    study.protocol.max_cycles += 1;
    let campaign = Campaign::new(&study, &output);
    for said in [
        campaign.run(Task::WHOLE, &silent).err().map(|it| it.to_string()),
        campaign.continue_branches(&silent).err().map(|it| it.to_string()),
    ] {
        let said = said.expect("another text");
        assert!(said.contains("protocol: the study has"), "{said}");
        assert!(said.contains("its text has"), "{said}");
    }
    assert!(!output.exists());
    let written = study.validated("study.toml").expect("it can be written");
    Campaign::new(&written, &output).run(Task::WHOLE, &silent).expect("it runs");
}
