//! Which shard of a picture a task of a launcher is to make, by the variables that the launcher sets.

use super::Shard;

/// Tasks that a launcher starts side by side: the variables of its rank, from 0, and of how many there are; the first pair that is set counts. `PMIX_RANK` comes
/// without a number of its own.
const RANKS: [(&str, &[&str]); 4] = [
    ("OMPI_COMM_WORLD_RANK", &["OMPI_COMM_WORLD_SIZE"]),
    ("PMI_RANK", &["PMI_SIZE"]),
    ("PMIX_RANK", &["PMIX_SIZE", "SLURM_STEP_NUM_TASKS", "SLURM_NTASKS"]),
    ("SLURM_PROCID", &["SLURM_NTASKS", "SLURM_NPROCS"]),
];

/// Of an array of jobs: the number of this one, of the first and of the last, and the step between.
const ARRAY: [&str; 4] =
    ["SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX", "SLURM_ARRAY_TASK_STEP"];
const ARRAY_COUNT: &str = "SLURM_ARRAY_TASK_COUNT";

impl Shard {
    /// The shard of this task, and in words which variables say so. An array of A jobs of N tasks each (Slurm, Open MPI, MPICH and others that set `PMI_RANK`,
    /// PMIx) makes A N shards: that of task R of job J, both from 0, is J N + R + 1.
    ///
    /// # Errors
    /// A sentence, if no launcher says which task this is, or what it says cannot be.
    pub fn of_launcher(variable: &dyn Fn(&str) -> Option<String>) -> Result<(Self, String), String> {
        let number = |name: &str| -> Result<Option<u32>, String> {
            let Some(text) = variable(name) else { return Ok(None) };
            let number = text.trim().parse().map_err(|_| format!("{name} is {text:?}, no whole number"))?;
            Ok(Some(number))
        };
        let (job, rank) = (array(&number)?, rank(&number)?);
        let words: Vec<&str> = [&job, &rank].into_iter().flatten().map(|task| task.words.as_str()).collect();
        if words.is_empty() {
            let names: Vec<&str> = std::iter::once(ARRAY[0]).chain(RANKS.map(|(rank, _)| rank)).collect();
            return Err(format!("no launcher says which task this is, none of {} is set: say I/N", names.join(", ")));
        }
        let words = words.join(", ");
        let [job, rank] = [job, rank].map(|task| task.map_or((0, 1), |task| (task.index, task.of)));
        let whole = |a: u32, b: u32, c: u32| a.checked_mul(b).and_then(|product| product.checked_add(c));
        let (index, of) = (whole(job.0, rank.1, rank.0).and_then(|i| i.checked_add(1)), whole(job.1, rank.1, 0));
        let shard = index.zip(of).ok_or("more tasks than shards").map_err(str::to_owned);
        let shard = shard.and_then(|(index, of)| Self::new(index, of));
        shard.map(|shard| (shard, words.clone())).map_err(|error| format!("{error} ({words})"))
    }

    /// A name of this shard's own made from that of the picture: `sky.exr` becomes `sky-03-of-12.exr`, with as many digits as the last has.
    #[must_use]
    pub fn name(self, file: &std::path::Path) -> std::path::PathBuf {
        let (index, of) = self.into();
        let digits = of.to_string().len();
        let mut name = file.file_stem().unwrap_or_default().to_os_string();
        name.push(format!("-{index:0digits$}-of-{of}"));
        if let Some(extension) = file.extension() {
            name.push(".");
            name.push(extension);
        }
        file.with_file_name(name)
    }
}

/// One of several tasks.
struct Task {
    /// From 0.
    index: u32,
    of: u32,
    words: String,
}

type Number<'a> = dyn Fn(&str) -> Result<Option<u32>, String> + 'a;

/// The job of an array, if there is one. Only one without gaps has an order that both ends agree on.
fn array(number: &Number<'_>) -> Result<Option<Task>, String> {
    let [id, first, last, step] = ARRAY.map(number);
    let Some(id) = id? else { return Ok(None) };
    let (Some(first), Some(last)) = (first?, last?) else {
        return Err(format!("{} is set, but not {} and {}", ARRAY[0], ARRAY[1], ARRAY[2]));
    };
    let step = step?.unwrap_or(1).max(1);
    if first > id || id > last || !(id - first).is_multiple_of(step) {
        return Err(format!("{} is {id}, but the array goes from {first} to {last} in steps of {step}", ARRAY[0]));
    }
    let of = ((last - first) / step).saturating_add(1);
    if let Some(count) = number(ARRAY_COUNT)?.filter(|count| *count != of) {
        return Err(format!(
            "{ARRAY_COUNT} is {count}, but {first} to {last} in steps of {step} are {of}: an array must have no gaps"
        ));
    }
    let words = format!("{} {id} of {first} to {last}", ARRAY[0]);
    Ok(Some(Task { index: (id - first) / step, of, words }))
}

/// The task of a launcher, if there is one.
fn rank(number: &Number<'_>) -> Result<Option<Task>, String> {
    for (rank, sizes) in RANKS {
        let Some(index) = number(rank)? else { continue };
        for size in sizes {
            if let Some(of) = number(size)? {
                if index >= of {
                    return Err(format!("{rank} is {index}, but {size} is {of}: ranks count from 0"));
                }
                return Ok(Some(Task { index, of, words: format!("{rank} {index} of {size} {of}") }));
            }
        }
        return Err(format!("{rank} is set, but not {}", sizes.join(" or ")));
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn of(set: &[(&str, &str)]) -> Result<String, String> {
        let variable = |name: &str| set.iter().find(|(own, _)| *own == name).map(|(_, value)| (*value).to_owned());
        Shard::of_launcher(&variable).map(|(shard, _)| shard.to_string())
    }

    fn slurm<'a>(id: &'a str, last: &'a str) -> Vec<(&'a str, &'a str)> {
        vec![("SLURM_ARRAY_TASK_ID", id), ("SLURM_ARRAY_TASK_MIN", "5"), ("SLURM_ARRAY_TASK_MAX", last)]
    }

    #[test]
    fn ranks_from_zero_are_shards_from_one() {
        assert_eq!(of(&[("OMPI_COMM_WORLD_RANK", "0"), ("OMPI_COMM_WORLD_SIZE", "4")]), Ok("1/4".into()));
        assert_eq!(of(&[("PMI_RANK", "3"), ("PMI_SIZE", "4")]), Ok("4/4".into()));
        assert_eq!(of(&[("PMIX_RANK", "1"), ("SLURM_NTASKS", "2"), ("SLURM_PROCID", "0")]), Ok("2/2".into()));
        assert_eq!(of(&[("SLURM_PROCID", "2"), ("SLURM_NTASKS", "3")]), Ok("3/3".into()));
    }

    #[test]
    fn arrays_begin_anywhere_and_go_in_steps() {
        assert_eq!(of(&slurm("5", "7")), Ok("1/3".into()));
        assert_eq!(of(&slurm("7", "7")), Ok("3/3".into()));
        let stepped =
            [slurm("9", "11"), vec![("SLURM_ARRAY_TASK_STEP", "2"), ("SLURM_ARRAY_TASK_COUNT", "4")]].concat();
        assert_eq!(of(&stepped), Ok("3/4".into()));
    }

    #[test]
    fn an_array_of_tasks_has_every_shard_once() {
        let mut all = Vec::new();
        for job in ["5", "6", "7"] {
            for rank in ["0", "1"] {
                all.push(
                    of(&[slurm(job, "7"), vec![("PMI_RANK", rank), ("PMI_SIZE", "2")]].concat()).expect("a shard"),
                );
            }
        }
        assert_eq!(all, ["1/6", "2/6", "3/6", "4/6", "5/6", "6/6"]);
    }

    #[test]
    fn what_a_launcher_does_not_say_is_never_guessed() {
        let refusal = |set: &[(&str, &str)]| of(set).expect_err("refused");
        assert!(refusal(&[]).contains("none of SLURM_ARRAY_TASK_ID"));
        assert!(refusal(&[("PMI_RANK", "1")]).contains("not PMI_SIZE"));
        assert!(refusal(&[("PMI_RANK", "4"), ("PMI_SIZE", "4")]).contains("count from 0"));
        assert!(refusal(&[("PMI_RANK", "x"), ("PMI_SIZE", "4")]).contains("no whole number"));
        assert!(refusal(&[("SLURM_ARRAY_TASK_ID", "1")]).contains("SLURM_ARRAY_TASK_MIN"));
        // --array=5,6,9
        let gaps = [slurm("6", "9"), vec![("SLURM_ARRAY_TASK_COUNT", "3")]].concat();
        assert!(refusal(&gaps).contains("no gaps"));
        assert!(refusal(&slurm("4", "9")).contains("from 5 to 9"));
        assert!(refusal(&slurm("6", "4000000000")).contains("65536"));
    }

    #[test]
    fn names_of_shards_differ_and_sort() {
        let name =
            |index, file: &str| Shard::new(index, 12).expect("possible").name(Path::new(file)).display().to_string();
        assert_eq!([name(3, "out/sky.exr"), name(11, "run.state")], ["out/sky-03-of-12.exr", "run-11-of-12.state"]);
    }
}
