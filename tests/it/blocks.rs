//! Blocks: every case is in just one, and comes out the same whichever blocks are run, and in what order.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::sync::Mutex;

use capsulemap::run::{self, Machine, Record};

use capsulemap::study::Study;

/// Studies that are cut differently: no start inherited, in one direction, and in all directions.
fn studies() -> Vec<Study> {
    let study = |points: usize, start: &str| {
        let text = format!(
            "[parameters]\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\n\
             [[axes]]\nname = \"p_d\"\nfrom = \"2 N\"\nto = \"6 N\"\npoints = {points}\n\
             [[axes]]\nname = \"omega\"\nfrom = \"18 rad/s\"\nto = \"80 rad/s\"\npoints = 100\n\
             [protocol]\nmax_cycles = 40\nexponent_cycles = 0\n{start}\n"
        );
        Study::parse("study.toml", &text).unwrap_or_else(|faults| panic!("{faults}"))
    };
    vec![
        study(13, ""),
        study(13, "[start]\ninherit = \"omega\""),
        study(7, "[start]\ninherit = \"p_d\"\ndirections = [\"upward\", \"downward\", \"afresh\"]"),
    ]
}

fn whole(study: &Study) -> Vec<Record> {
    let records = Mutex::new(Vec::new());
    let keep = |record| records.lock().expect("a lock").push(record);
    run::run(study, Machine::default(), keep).expect("the study runs");
    let mut records = records.into_inner().expect("a lock");
    records.sort_by_key(|record: &Record| record.index);
    records
}

fn blocks(study: &Study, numbers: &[usize], machine: Machine) -> BTreeMap<usize, Vec<Record>> {
    let found = Mutex::new(BTreeMap::new());
    run::run_blocks(
        study,
        machine,
        numbers,
        None,
        |_, _| ControlFlow::Continue(()),
        |block, records| {
            let before = found.lock().expect("a lock").insert(block, records);
            assert!(before.is_none(), "block {block} came twice");
            ControlFlow::Continue(())
        },
    )
    .expect("the blocks run");
    found.into_inner().expect("a lock")
}

#[test]
fn every_case_is_in_one_block() {
    for study in studies() {
        let mut seen = vec![0; study.cases()];
        let mut chains = 0;
        for number in 0..study.blocks() {
            assert_eq!(study.block(number).start, chains);
            chains = study.block(number).end;
            let cases = study.block_cases(number);
            assert!(cases.is_sorted() && cases.len() <= 1024);
            cases.iter().for_each(|&case| seen[case] += 1);
        }
        assert_eq!(chains, study.chains());
        assert!(seen.iter().all(|&count| count == 1) && study.blocks() > 1);
    }
}

#[test]
fn a_block_has_the_same_records_whatever_is_run_beside_it() {
    for study in studies() {
        let whole = whole(&study);
        let last = study.blocks() - 1;
        for (numbers, threads) in [(vec![last, 0], Some(2)), (vec![1], Some(1)), (vec![], None)] {
            let machine = Machine { threads, ..Machine::default() };
            let found = blocks(&study, &numbers, machine);
            assert_eq!(found.len(), numbers.len());
            for (block, records) in found {
                let expected: Vec<Record> =
                    study.block_cases(block).iter().map(|&case| whole[case].clone()).collect();
                assert!(same(&records, &expected), "block {block}");
            }
        }
    }
}

#[test]
fn a_run_stops_when_it_is_asked_to() {
    let study = &studies()[1];
    let numbers: Vec<usize> = (0..study.blocks()).collect();
    let machine = Machine { threads: Some(1), ..Machine::default() };
    let count = Mutex::new(0);
    run::run_blocks(
        study,
        machine,
        &numbers,
        None,
        |_, _| ControlFlow::Continue(()),
        |_, _| {
            *count.lock().expect("a lock") += 1;
            ControlFlow::Break(())
        },
    )
    .expect("the blocks run");
    assert!((1..study.blocks()).contains(&count.into_inner().expect("a lock")));
}

#[test]
fn the_first_blocks_are_spread_over_the_study() {
    for blocks in [1, 2, 3, 8, 60, 1000, 8192] {
        let order = capsulemap::study::spread(blocks);
        assert_eq!(order.iter().collect::<BTreeSet<_>>().len(), blocks);
        for part in [blocks / 10, blocks / 3] {
            let mean = order[..part].iter().sum::<usize>() as f64 / part as f64;
            let off = mean / (blocks as f64 / 2.0) - 1.0;
            assert!(part < 20 || off.abs() < 0.1, "{blocks} {part} {off}");
        }
    }
}

/// Whether all bits are the same; what is not a number is equal to itself.
fn same(a: &[Record], b: &[Record]) -> bool {
    format!("{a:?}") == format!("{b:?}")
}
