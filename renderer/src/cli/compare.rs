//! `airlight compare`.

use super::output::println;
use super::picture::has_extension;
use super::progress::percent;
use super::words::share;
use super::{Failure, Outcome};
use crate::compare::{Comparison, Difference, Scores, Worst, difference_picture};
use crate::film::{Channels, png};
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Flags of `airlight compare`.
#[derive(Debug, Args)]
pub(super) struct CompareArgs {
    /// Picture to compare with: an EXR file
    #[arg(value_name = "A.exr")]
    pub a: PathBuf,
    /// Picture that is compared
    #[arg(value_name = "B.exr")]
    pub b: PathBuf,
    /// Draw the differences of luminance too, blue where B is darker, red where it is brighter, above a bar from one end of the scale to the other
    /// [default: no picture]
    #[arg(short, long, value_name = "DIFF.png")]
    pub output: Option<PathBuf>,
    /// Difference over A's mean luminance that the ends of the colours stand for, 1e-5 to 1: 5% or 0.05 [default: the
    /// least of 1, 2, 5 times a power of ten that holds 99 % of the pixels]
    #[arg(long, value_name = "S", value_parser = share, requires = "output")]
    pub scale: Option<f64>,
    /// Exit with 1 if a channel differs by more than this, rms over its mean in A, 1e-5 to 1: 1% or 0.01 [default: exit with 0 whatever
    /// the difference]
    #[arg(long, value_name = "E", value_parser = share)]
    pub within: Option<f64>,
    /// Write the numbers as JSON
    #[arg(long)]
    pub json: bool,
    /// Say nothing but errors: the exit code of --within, the picture of -o
    #[arg(long, conflicts_with = "json")]
    pub quiet: bool,
}

/// Exit code 1 says that pictures differ, so that whatever keeps them from being compared is 2.
pub(super) fn run(args: &CompareArgs) -> Result<Outcome, Failure> {
    compare(args).map_err(|failure| Failure { code: 2, ..failure })
}

fn compare(args: &CompareArgs) -> Result<Outcome, Failure> {
    if let Some(path) = args.output.as_deref() {
        if !has_extension(path, "png") {
            return Err(Failure::usage(format!("{}: the name of the differences must end in .png", path.display())));
        }
        tables::file::check_writable(path).map_err(|error| super::unwritable(path, &error))?;
    }
    let (a, b) = (read(&args.a)?, read(&args.b)?);
    let names = || format!("{} and {}", args.a.display(), args.b.display());
    let unlike = |error: &dyn std::fmt::Display| Failure::usage(format!("{}: {error}", names()));
    let comparison = Comparison::new(&a, &b).map_err(|error| unlike(&error))?;
    let scale = match &args.output {
        Some(path) => {
            let lacking = "the differences of luminance want R, G and B in both: leave out -o";
            let shown = difference_picture(&a, &b, args.scale).ok_or_else(|| unlike(&lacking))?;
            let bytes = png::file(shown.size, &shown.pixels).map_err(Failure::error)?;
            super::announce(path, args.quiet || args.json);
            super::write(path, &bytes)?;
            Some(shown.scale)
        }
        None => None,
    };
    let within = args.within.map(|asked| (asked, comparison.most() <= asked));
    if args.json {
        let value = json_of(&comparison, scale, within);
        println!("{}", serde_json::to_string_pretty(&value).map_err(Failure::error)?);
    } else if !args.quiet {
        describe(&comparison, scale.zip(args.output.as_deref()), within);
    }
    match within {
        Some((_, false)) => Ok(Outcome::Differs),
        _ => Ok(Outcome::Done),
    }
}

fn read(path: &Path) -> Result<Channels, Failure> {
    let at = |error: &dyn std::fmt::Display| Failure::error(format!("{}: {error}", path.display()));
    let bytes = std::fs::read(path).map_err(|error| at(&format!("cannot be read: {error}")))?;
    Channels::read(&bytes).map_err(|error| at(&format!("no picture that can be compared: {error}")))
}

fn describe(comparison: &Comparison, shown: Option<(f64, &Path)>, within: Option<(f64, bool)>) {
    let (width, height) = comparison.size;
    println!("pictures    {width} x {height}; differences are B - A, relative to the mean of A");
    println!("channel            rms      mean     worst  (pixel)        z rms   z mean   z worst  (pixel)");
    for difference in &comparison.differences {
        println!("{}", line(difference));
    }
    for difference in comparison.differences.iter().filter(|difference| difference.not_finite > 0) {
        println!("not finite  {} pixels of {}", difference.not_finite, difference.channel);
    }
    if let Some(colours) = &comparison.colours {
        let Worst { pixel: (x, y), off, .. } = colours.worst;
        println!(
            "colour      {:.2} units of CIEDE2000 in the mean, 95 % of the pixels at most {:.2}, worst {off:.2} ({x},{y})",
            colours.mean, colours.most_of_95_percent
        );
    }
    if !comparison.only_one.is_empty() {
        println!("only in one {}", comparison.only_one.join(", "));
    }
    if let Some((scale, path)) = shown {
        println!("written     {} (luminance from -{scale} blue to +{scale} red, of A's mean)", path.display());
    }
    if let Some((asked, holds)) = within {
        let verdict = if holds { "within" } else { "not within" };
        println!("{verdict:11} {}: the largest rms is {}", percent(asked), percent(comparison.most()));
    }
}

fn line(difference: &Difference) -> String {
    let signed = |share: f64| format!("{}{}", if share < 0.0 { "-" } else { "+" }, percent(share.abs()));
    let place = |worst: &Worst| format!("({},{})", worst.pixel.0, worst.pixel.1);
    let Difference { channel, rms, mean, worst, scores, .. } = difference;
    let scores = scores.as_ref().map_or(String::new(), |Scores { rms, mean, worst, .. }| {
        format!("{rms:8.2} {mean:+8.3} {:+9.1}  {}", worst.off, place(worst))
    });
    let numbers = format!("{:>9} {:>9} {:>9}  {:12}", percent(*rms), signed(*mean), signed(worst.off), place(worst));
    format!("{channel:13} {numbers} {scores}").trim_end().to_owned()
}

fn json_of(comparison: &Comparison, scale: Option<f64>, within: Option<(f64, bool)>) -> Value {
    let worst = |worst: &Worst| json!({ "pixel": [worst.pixel.0, worst.pixel.1], "off": worst.off, "a": worst.values[0], "b": worst.values[1] });
    let channels = comparison.differences.iter().map(|difference| {
        json!({
            "channel": difference.channel,
            "scale": difference.scale,
            "rms": difference.rms,
            "mean": difference.mean,
            "worst": worst(&difference.worst),
            "not_finite_pixels": difference.not_finite,
            "z": difference.scores.map(|scores| json!({
                "rms": scores.rms,
                "mean": scores.mean,
                "worst": worst(&scores.worst),
                "pixels": scores.pixels,
            })),
        })
    });
    json!({
        "width_px": comparison.size.0,
        "height_px": comparison.size.1,
        "largest_rms": comparison.most(),
        "within": within.map(|(asked, holds)| json!({ "asked": asked, "holds": holds })),
        "channels": channels.collect::<Vec<_>>(),
        "ciede2000": comparison.colours.map(|colours| json!({
            "mean": colours.mean,
            "most_of_95_percent": colours.most_of_95_percent,
            "worst": worst(&colours.worst),
        })),
        "only_in_one": comparison.only_one,
        "picture_scale": scale,
    })
}
