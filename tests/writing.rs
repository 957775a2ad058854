//! What stands under a final name is whole: on a full disk, in a folder that cannot be written, while two processes
//! write the same file, and after a kill at any moment. `AIRLIGHT_ROUNDS` makes the repeated tests longer.

use airlight_tests::{Folder, from_environment, program, root};
use renderer::sampling::Sampler;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A command of the project in the root of the project, silent.
fn command(words: &[&str]) -> Command {
    let mut command = Command::new(program(words[0]));
    command.args(&words[1..]).current_dir(root()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// Spheres whose solutions are a file of some 100 kB; another `x`, another file.
fn spheres(folder: &Folder, name: &str, x: f64) -> PathBuf {
    let rows: String = (0..250).map(|i| format!("{},1.5,-0.01\n", x + f64::from(i) / 100.0)).collect();
    let path = folder.path().join(name);
    std::fs::write(&path, format!("x,m_re,m_im\n{rows}")).expect("written");
    path
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path of ASCII")
}

/// Runs `script` in `sh` with arguments $1, $2, ...
fn shell(script: &str, arguments: &[&str]) -> Output {
    Command::new("sh").args(["-c", script, "sh"]).args(arguments).current_dir(root()).output().expect("sh runs")
}

/// The error is one sentence, after what was going to be replaced.
fn one_sentence(output: &Output, path: &str, cause: &str) {
    let words = String::from_utf8_lossy(&output.stderr);
    let said: Vec<&str> = words.lines().filter(|line| !line.starts_with("replaces ")).collect();
    let [words] = said[..] else { panic!("{words}") };
    assert!(words.contains(path) && words.contains(cause), "{words:?} does not name {path} and {cause:?}");
    assert!(!output.status.success());
}

fn names(folder: &Path) -> Vec<String> {
    let name =
        |entry: std::io::Result<std::fs::DirEntry>| entry.expect("entry").file_name().into_string().expect("text");
    std::fs::read_dir(folder).expect("listed").map(name).collect()
}

#[test]
fn a_file_that_does_not_fit_leaves_the_old_one() {
    let folder = Folder::new("full");
    let (cases, out) = (spheres(&folder, "in.csv", 1.0), folder.path().join("out.csv"));
    std::fs::write(&out, "old").expect("written");
    // A limit of the system on the size of a file (in blocks of 512 bytes) fails at the same call as a full disk.
    let script = "trap '' XFSZ; ulimit -f 16; exec \"$1\" mie --cases \"$2\" --out \"$3\"";
    let output = shell(script, &[text(&program("airlight-tools")), text(&cases), text(&out)]);
    one_sentence(&output, "out.csv", "File too large");
    assert_eq!(std::fs::read(&out).expect("there"), b"old");
    assert_eq!(names(folder.path()).len(), 2, "litter: {:?}", names(folder.path()));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_and_a_read_only_folder_are_one_sentence_each() {
    let folder = Folder::new("mounts");
    let cases = spheres(&folder, "in.csv", 1.0);
    let disk = folder.path().join("disk");
    std::fs::create_dir_all(&disk).expect("made");
    // Mounts of a name space of its own; where the system allows none, what fails in their stead is a limit on the
    // size of files, and a path that leads through a file.
    let mounted = shell("unshare -rm mount -t tmpfs tmpfs \"$1\"", &[text(&disk)]).status.success();
    let tools = program("airlight-tools");
    let arguments = [text(&tools), text(&cases), text(&disk)];
    let inside = |script: &str| {
        let script = format!(
            "{script}; printf old > \"$3/out.csv\"; $LOCK; \"$1\" mie --cases \"$2\" --out \"$3/out.csv\"; code=$?; cat \"$3/out.csv\"; ls \"$3\" | wc -l; exit $code"
        );
        let script = script.replace("$LOCK", if script.contains("rw") { "mount -o remount,ro \"$3\"" } else { "true" });
        Command::new("unshare").args(["-rm", "sh", "-c", &script, "sh"]).args(arguments).output().expect("runs")
    };
    if mounted {
        for (script, cause) in [
            ("mount -t tmpfs -o size=16k tmpfs \"$3\"", "No space left on device"),
            ("mount -t tmpfs -o rw,size=1m tmpfs \"$3\"", "Read-only file system"),
        ] {
            let output = inside(script);
            one_sentence(&output, "out.csv", cause);
            assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "old1", "old content, one file");
        }
    } else {
        let through = cases.join("out.csv");
        let output = shell("exec \"$1\" mie --cases \"$2\" --out \"$2/out.csv\"", &arguments);
        one_sentence(&output, text(&through), "Not a directory");
    }
}

#[test]
fn a_picture_that_cannot_be_written_is_refused_before_the_work() {
    let folder = Folder::new("through");
    let file = folder.path().join("file");
    std::fs::write(&file, "old").expect("written");
    // A folder in the way of the PNG.
    std::fs::create_dir_all(folder.path().join("sky.png")).expect("made");
    let out = folder.path().join("sky.exr");
    let script = "exec \"$1\" render --width 8 --height 8 --spp 1 -o \"$2\"";
    one_sentence(&shell(script, &[text(&program("airlight")), text(&out)]), "sky.png", "irectory");
    assert!(!out.exists(), "half of the result was written");
    let output = shell(script, &[text(&program("airlight")), text(&file.join("sky.exr"))]);
    one_sentence(&output, text(&file), "no such folder");
    assert_eq!(std::fs::read(&file).expect("there"), b"old");
}

#[test]
fn two_processes_that_write_the_same_file_leave_one_whole_version() {
    let folder = Folder::new("both");
    let out = folder.path().join("out.csv");
    let versions = [("a.csv", 1.0), ("b.csv", 2.0)].map(|(name, x)| {
        let cases = spheres(&folder, name, x);
        let words = ["airlight-tools", "mie", "--cases", text(&cases), "--out", text(&out)].map(str::to_owned);
        let run = || command(&words.each_ref().map(String::as_str));
        assert!(run().status().expect("runs").success());
        (std::fs::read(&out).expect("there"), words)
    });
    assert!(versions[0].0 != versions[1].0);
    let (rounds, mut looks) = (from_environment("AIRLIGHT_ROUNDS", 12), 0_u64);
    for _ in 0..rounds {
        let mut both = versions
            .each_ref()
            .map(|(_, words)| command(&words.each_ref().map(String::as_str)).spawn().expect("starts"));
        while both.iter_mut().any(|child| child.try_wait().expect("asked").is_none()) {
            let found = std::fs::read(&out).expect("always there");
            assert!(versions.iter().any(|(whole, _)| *whole == found), "{} bytes are no version", found.len());
            looks += 1;
        }
        assert!(both.iter_mut().all(|child| child.wait().expect("ended").success()));
    }
    assert_eq!(names(folder.path()).len(), 3, "litter: {:?}", names(folder.path()));
    assert!(looks > rounds, "{looks} looks in {rounds} rounds");
}

/// Kills `run` at a moment: after a share of `normal`, or some microseconds after a temporary file has appeared in
/// `folder`. Says whether it was killed in time.
fn kill(mut run: Child, folder: &Path, normal: Duration, dice: &mut Sampler) -> bool {
    let start = Instant::now();
    let [kind, share] = dice.uniform_2d();
    let before = names(folder);
    if kind < 0.5 {
        std::thread::sleep(normal.mul_f64(share));
    } else {
        let new = |name: String| name.contains(".tmp-") && !before.contains(&name);
        while start.elapsed() < normal * 4 && !names(folder).into_iter().any(new) {}
        std::thread::sleep(Duration::from_micros((2000.0 * share * share) as u64));
    }
    let _ = run.kill(); // SIGKILL; fails only if the program has ended
    !run.wait().expect("ended").success()
}

#[test]
fn a_kill_at_any_moment_leaves_the_old_file_the_new_one_or_none() {
    let folder = Folder::new("killed");
    let cases = spheres(&folder, "in.csv", 1.0);
    let at = |name: &str| folder.path().join(name);
    let (data, plots, csv, exr) = (at("data"), at("plots"), at("mie/out.csv"), at("sky/sky.exr"));
    for sub in ["data", "plots", "mie", "sky"] {
        std::fs::create_dir_all(at(sub)).expect("made");
    }
    let (mie, sky) = (at("mie"), at("sky"));
    let commands: [(&Path, Vec<&str>); 4] = [
        (data.as_path(), vec!["airlight-tools", "build", "--only", "ozone-profiles", "--data", text(&data)]),
        (mie.as_path(), vec!["airlight-tools", "mie", "--cases", text(&cases), "--out", text(&csv)]),
        // A receipt says how long it took, so it is another one each time.
        (
            sky.as_path(),
            vec!["airlight", "render", "--width", "64", "--height", "64", "--no-receipt", "-o", text(&exr)],
        ),
        (plots.as_path(), vec!["airlight-tools", "plot", "ozone-months", "--out", text(&plots)]),
    ];
    let mut dice = Sampler::new(1, 0, 0);
    let (mut kills, rounds) = (0, from_environment("AIRLIGHT_ROUNDS", 6));
    for (folder, words) in commands {
        let start = Instant::now();
        assert!(command(&words).status().expect("runs").success(), "{words:?}");
        let normal = start.elapsed();
        let whole: Vec<(PathBuf, Vec<u8>)> = names(folder)
            .into_iter()
            .map(|name| folder.join(name))
            .map(|path| (path.clone(), std::fs::read(path).expect("there")))
            .collect();
        assert!(!whole.is_empty());
        for round in 0..rounds {
            // Over nothing, and over an old file.
            for (path, _) in &whole {
                if round % 2 == 0 { std::fs::remove_file(path) } else { std::fs::write(path, "old") }.expect("set up");
            }
            kills += u64::from(kill(command(&words).spawn().expect("starts"), folder, normal, &mut dice));
            for (path, whole) in &whole {
                match std::fs::read(path) {
                    Ok(found) => assert!(
                        found == *whole || (round % 2 == 1 && found == b"old"),
                        "{} holds {} of {} bytes",
                        path.display(),
                        found.len(),
                        whole.len()
                    ),
                    Err(error) => assert!(round % 2 == 0, "{}: the old file is gone: {error}", path.display()),
                }
                if !path.exists() {
                    std::fs::write(path, "old").expect("set up");
                }
            }
            let strange = |name: &String| {
                !tables::file::is_temporary(name) && whole.iter().all(|(path, _)| !path.ends_with(name))
            };
            assert_eq!(names(folder).into_iter().find(strange), None, "after {words:?}");
        }
        // What was left behind hinders nobody.
        assert!(command(&words).status().expect("runs").success(), "{words:?} with leftovers");
        for (path, whole) in &whole {
            assert!(std::fs::read(path).expect("there") == *whole, "{}", path.display());
        }
    }
    assert!(kills >= rounds, "only {kills} programs were killed in time");
}
