//! What stands below the flags in the help: examples, and what the program ends with.

/// Of the program itself.
pub(super) const PROGRAM: &str = "\
Exit codes:
  0    done
  1    an error: a file that cannot be read or written, a run that fails;
       of compare --within: the pictures differ by more
  2    a flag or a scene that cannot be; of compare: pictures that cannot be compared
  130  stopped by Ctrl-C; what was there is written first

Results go to files and what they are to standard output; progress, on a terminal only, and errors,
one sentence each, to standard error. With the variable NO_COLOR set the help has no colours, and
nothing else has any. The flags of a command: airlight COMMAND --help";

pub(super) const RENDER: &str = "\
Examples:
  airlight render                                              the clear sky, the sun at 30 degrees: sky.exr, .png, .json
  airlight render --sun-elevation 5 --biome desert-dust --aod 0.4 --camera pinhole -o dusk.exr
  airlight render scene.toml --width 1024 --height 1024        a scene file, larger
  airlight render sky.exr --exposure 12                        the scene of a picture again
  airlight render --method paths --error 2% --checkpoint run.state
  airlight render --shard 1/3 --method paths --spp 4096        a third of the samples, for merge
  airlight render --auto --error 1%                            as cheaply as that error allows
  airlight render --json --width 64 --height 64                the receipt on standard output";

pub(super) const PLAN: &str = "\
Examples:
  airlight plan --error 1%                                     of the clear sky
  airlight plan scene.toml --error 0.5% --metric luminance
  airlight plan --biome urban --error 1 --metric colour --json";

pub(super) const SEQUENCE: &str = "\
Examples:
  airlight sequence --what sunset --frames 240 -o sunset-####.png
  airlight sequence --what day --date 2026-06-21T12:00:00Z --latitude 48.2 --longitude 16.4 -o day-###.png
  airlight sequence --vary sun_elevation_deg=10:-6 --vary altitude_km=0:3 --frames 48 -o rise-##.exr
  airlight sequence --frames 240 -o sunset-####.png --skip-existing      goes on where it was stopped";

pub(super) const LIGHT: &str = "\
Examples:
  airlight light --for blender -o sky.exr                      the map, and sky.json with the sun
  airlight light --for mitsuba --sun-elevation 12 --width 2048 -o sky.exr";

pub(super) const SCENE: &str = "\
Examples:
  airlight scene new --list                                    the scenes of the gallery
  airlight scene new scene.toml                                a file with every key and its range
  airlight scene check scenes/*.json
  airlight scene show sky.exr                                  what a picture is of
  airlight scene schema > scene.schema.json                    for editors";

pub(super) const GALLERY: &str = "\
Examples:
  airlight gallery --list
  airlight gallery 6.4 -o pictures                             one figure of the thesis
  airlight gallery --size 1024 --keep-tables tables";

pub(super) const MERGE: &str = "\
Examples:
  airlight merge sky-*-of-16.exr -o sky.exr                    pictures with their states beside them
  airlight merge a.state b.state --checkpoint both.state -o both.exr";

pub(super) const COMPARE: &str = "\
Examples:
  airlight compare a.exr b.exr
  airlight compare a.exr b.exr -o diff.png --scale 5%
  airlight compare a.exr b.exr --within 1% --quiet && echo alike

Exit codes: 0 it ran, 1 a channel differs by more than --within, 2 the pictures cannot be compared";

pub(super) const DOCTOR: &str = "\
Examples:
  airlight doctor scene.toml                                   before it is rendered
  airlight doctor sky.exr                                      its pixels, and its scene
  airlight doctor sky.exr --json";

pub(super) const RADIANCE: &str = "\
Example:
  airlight radiance cases.json -o answers.csv --method paths --error 1%";

pub(super) const BENCH: &str = "\
Examples:
  airlight bench anchors --seconds 2
  airlight bench solved --biome none --paths 1024";

pub(super) const STUDY: &str = "\
Examples:
  airlight study ladder --quick -o ladder.csv                  some minutes; airlight-tools chart ladder.csv draws it
  airlight study strip -o strip.png";

pub(super) const SWEEP: &str = "\
Examples:
  airlight sweep --paths 1e6
  airlight sweep --seed 1 --scene 12 --path 7                  one path again";
