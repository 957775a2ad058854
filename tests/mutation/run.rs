//! Runs readers on mutated inputs, watches them, and keeps count.

use super::{Target, memory, mutate};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// The most bytes of an error.
const MAX_ERROR: usize = 4096;

/// Time after which a reader hangs. Sound inputs take milliseconds; a busy machine must not fail.
const PATIENCE: Duration = Duration::from_secs(20);

/// Inputs of a block: a thread works on one block at a time, and bears its name, which the runtime prints if the
/// stack overflows.
const BLOCK: u64 = 250;

/// What to run.
#[derive(Debug, Clone, Copy)]
pub struct Plan {
    /// Seed of the mutations.
    pub seed: u64,
    /// Inputs of each target; with `time` the most of them.
    pub inputs: u64,
    /// When to stop.
    pub time: Option<Duration>,
    /// Threads.
    pub threads: usize,
}

/// What came of one input.
#[derive(Debug, Clone)]
pub struct Verdict {
    /// Whether it was read; `Err` has the sentence of the refusal.
    pub result: Result<(), String>,
    /// Bytes of memory at the most, the file included where the program holds it.
    pub memory: usize,
    /// Bytes allowed.
    pub allowed: usize,
    /// Time.
    pub time: Duration,
}

/// A reader that failed on an input.
#[derive(Debug, Clone)]
pub struct Failure {
    /// Number of the target in the list.
    pub target: usize,
    /// Number of the input.
    pub index: u64,
    /// What went wrong.
    pub what: String,
}

/// The figures of one target.
#[derive(Debug, Clone, Default)]
pub struct Figures {
    /// Inputs read or refused.
    pub inputs: u64,
    /// Those that were read.
    pub accepted: u64,
    /// Memory over what is allowed, 1 at most, the largest.
    pub memory: f64,
    /// Time, the longest.
    pub slowest: Duration,
    /// Bytes of the longest error.
    pub longest_error: usize,
    /// Bytes of the largest input.
    pub largest: usize,
}

impl Figures {
    fn add(&mut self, length: usize, verdict: &Verdict) {
        self.inputs += 1;
        self.accepted += u64::from(verdict.result.is_ok());
        self.memory = self.memory.max(verdict.memory as f64 / verdict.allowed as f64);
        self.slowest = self.slowest.max(verdict.time);
        self.longest_error = self.longest_error.max(verdict.result.as_ref().err().map_or(0, String::len));
        self.largest = self.largest.max(length);
    }

    /// Adds up two figures.
    pub fn merge(&mut self, other: &Self) {
        self.inputs += other.inputs;
        self.accepted += other.accepted;
        self.memory = self.memory.max(other.memory);
        self.slowest = self.slowest.max(other.slowest);
        self.longest_error = self.longest_error.max(other.longest_error);
        self.largest = self.largest.max(other.largest);
    }
}

/// Reads one input and judges it.
///
/// # Errors
/// What is wrong: a panic with its message, too much memory, an error that is no sentence.
pub fn probe(target: &Target, bytes: &[u8]) -> Result<Verdict, String> {
    let start = Instant::now();
    let (held, result) = memory::most_during(|| catch_unwind(AssertUnwindSafe(|| (target.read)(bytes))));
    let time = start.elapsed();
    let result = result.map_err(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        let text = text.or_else(|| panic.downcast_ref::<&str>().map(|&text| text.into()));
        format!("panic: {}", text.unwrap_or_default())
    })?;
    let (memory, allowed) = (held + if target.held { bytes.len() } else { 0 }, 4 * bytes.len() + target.free);
    if memory > allowed {
        return Err(format!("{memory} bytes of memory for a file of {} bytes, {allowed} are allowed", bytes.len()));
    }
    if let Err(sentence) = &result
        && (sentence.is_empty() || sentence.len() > MAX_ERROR)
    {
        return Err(format!("an error of {} bytes", sentence.len()));
    }
    Ok(Verdict { result, memory, allowed, time })
}

/// How to do it again.
#[must_use]
pub fn replay_command(name: &str, seed: u64, index: u64) -> String {
    format!("cargo run --bin airlight-fuzz -- --target '{name}' --seed {seed} --replay {index}")
}

/// Input `index` of a target under `seed`.
#[must_use]
pub fn input(target: &Target, seed: u64, index: u64) -> Vec<u8> {
    // A number for the name that stays when targets are added (FNV-1a).
    let fold = |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    let number = target.name.bytes().fold(0xcbf2_9ce4_8422_2325, fold);
    mutate(target.form, &target.seeds, seed, number, index)
}

/// Runs a plan over the targets, in turns of some hundred inputs. Every failing input is saved in `folder` first. A
/// reader that hangs ends the program with the sentence that `hang` gets, after its input is saved.
///
/// # Panics
/// If a thread cannot be started.
pub fn run(targets: &[Target], plan: Plan, folder: &Path, hang: fn(&str)) -> (Vec<Figures>, Vec<Failure>) {
    let start = Instant::now();
    let done = AtomicBool::new(false);
    let turn = AtomicUsize::new(0);
    let figures = Mutex::new(vec![Figures::default(); targets.len()]);
    let failures = Mutex::new(Vec::new());
    // What each worker is at, and since when.
    let at: Vec<Mutex<Option<(usize, u64, Instant)>>> = (0..plan.threads).map(|_| Mutex::new(None)).collect();
    let block = |worker: usize, number: usize, from: u64| {
        let mut mine = Figures::default();
        for index in from..(from + BLOCK).min(plan.inputs) {
            let bytes = input(&targets[number], plan.seed, index);
            *lock(&at[worker]) = Some((number, index, Instant::now()));
            let verdict = probe(&targets[number], &bytes);
            *lock(&at[worker]) = None;
            match verdict {
                Ok(verdict) => mine.add(bytes.len(), &verdict),
                Err(what) => {
                    let saved = save(folder, &targets[number].name, plan.seed, index, &bytes);
                    lock(&failures).push(Failure { target: number, index, what: format!("{what}{saved}") });
                }
            }
        }
        lock(&figures)[number].merge(&mine);
    };
    let work = |worker: usize| {
        loop {
            let turn = turn.fetch_add(1, Ordering::Relaxed);
            let (number, from) = (turn % targets.len(), (turn / targets.len()) as u64 * BLOCK);
            if from >= plan.inputs || plan.time.is_some_and(|time| start.elapsed() >= time) {
                return;
            }
            std::thread::scope(|scope| {
                let name = format!("{} from {from}", targets[number].name);
                let block = || block(worker, number, from);
                std::thread::Builder::new().name(name).spawn_scoped(scope, block).expect("a thread");
            });
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !done.load(Ordering::Relaxed) {
                std::thread::sleep(Duration::from_millis(50));
                for (number, index, since) in at.iter().filter_map(|at| *lock(at)) {
                    if since.elapsed() > PATIENCE {
                        let name = &targets[number].name;
                        let saved = save(folder, name, plan.seed, index, &input(&targets[number], plan.seed, index));
                        hang(&format!("{name} hangs{saved}: {}", replay_command(name, plan.seed, index)));
                        std::process::abort();
                    }
                }
            }
        });
        let workers: Vec<_> = (0..plan.threads).map(|worker| scope.spawn(move || work(worker))).collect();
        let ended: Vec<_> = workers.into_iter().map(std::thread::ScopedJoinHandle::join).collect();
        done.store(true, Ordering::Relaxed);
        assert!(ended.iter().all(Result::is_ok), "a worker of the harness failed");
    });
    let (figures, failures) = (lock(&figures).clone(), lock(&failures).clone());
    (figures, failures)
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Saves an input and says where, or that it could not be saved.
fn save(folder: &Path, name: &str, seed: u64, index: u64, bytes: &[u8]) -> String {
    let name: String = name.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
    let path = folder.join(format!("{name}-{seed}-{index}"));
    match std::fs::create_dir_all(folder).and_then(|()| tables::file::replace(&path, bytes)) {
        Ok(()) => format!(" (saved as {})", path.display()),
        Err(error) => format!(" (cannot be saved: {error})"),
    }
}
