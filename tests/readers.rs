//! A share of what `airlight-fuzz` does, and that it would notice.

use airlight_tests::mutation::{Form, Plan, Target, input, memory, probe, replay_command, run, targets};
use airlight_tests::{Folder, from_environment};

#[global_allocator]
static MEMORY: memory::Counting = memory::Counting;

#[test]
fn no_reader_panics_or_takes_more_memory_than_it_may() {
    let targets = targets();
    let folder = Folder::new("mutation");
    let plan = Plan { seed: 1, inputs: from_environment("AIRLIGHT_INPUTS", 250), time: None, threads: 2 };
    let (figures, failures) = run(&targets, plan, folder.path(), |sentence| panic!("{sentence}"));
    let told: Vec<String> = failures
        .iter()
        .map(|f| format!("{}: {}", f.what, replay_command(&targets[f.target].name, plan.seed, f.index)))
        .collect();
    assert!(told.is_empty(), "{}", told.join("\n"));
    for (target, figures) in targets.iter().zip(&figures) {
        // Mutations that all fail at the first check, or none of them, would test little.
        assert!(figures.accepted > 0 && figures.accepted < figures.inputs, "{}: {figures:?}", target.name);
    }
}

#[test]
fn every_seed_is_read() {
    for target in targets() {
        for seed in &target.seeds {
            let verdict = probe(&target, seed).expect("sound");
            assert_eq!(verdict.result, Ok(()), "{}", target.name);
        }
    }
}

#[test]
fn equal_seeds_give_equal_inputs_and_others_do_not() {
    let target = &targets()[0];
    assert_eq!(input(target, 1, 7), input(target, 1, 7));
    assert_ne!(input(target, 1, 7), input(target, 2, 7));
    assert_ne!(input(target, 1, 7), input(target, 1, 8));
}

#[test]
fn a_panic_too_much_memory_and_an_endless_error_are_noticed() {
    let target = |held, read| Target { name: "bad".into(), form: Form::Text, held, free: 1 << 20, seeds: vec![], read };
    let words = |target: Target, length: usize| probe(&target, &vec![b'x'; length]).expect_err("unnoticed");
    assert!(words(target(true, |_| panic!("at the disco")), 1).contains("panic: at the disco"));
    // 4.5 files and 1 MiB.
    let greedy = |bytes: &[u8]| {
        let copy = vec![0_u8; 9 * bytes.len() / 2 + (1 << 20)];
        if copy.len() > bytes.len() { Ok(()) } else { Err("never".into()) }
    };
    assert!(words(target(false, greedy), 1000).contains("bytes of memory"));
    assert!(words(target(true, |_| Err("x".repeat(5000))), 1).contains("an error of 5000 bytes"));
}
