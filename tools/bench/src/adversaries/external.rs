//! Runs external libraries over adversarial scenes, each in a process of its own. A stack overflow, an endless build or
//! unbounded memory ends that process alone and becomes a row of the table.

use crate::backend::{Answer, Unavailable, catch};
use crate::extremes::ROUNDING;
use crate::memory;
use crate::queries::Queries;
use crate::rounds::thread_seconds;
use crate::scene::Scene;
use anyhow::{Context, Result, bail};
use p2m_core::{BruteForce, ClosestPoint, PrimitiveSet};
use p2m_testkit::adversaries::{Adversary, queries};
use p2m_testkit::truth::Truth;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// The number of queries of each scene.
pub(super) const QUERIES: usize = 300;
/// The names of the external libraries in the list of backends.
pub(super) const LIBRARIES: [&str; 2] = ["parry3d-f64", "bvh"];
/// The time limit of a process for a scene of 20,000 primitives; it grows with the number of primitives.
pub(super) const TIME_LIMIT: Duration = Duration::from_secs(60);
/// The largest number of bytes that a process may hold, where the system reports it.
const MAX_RESIDENT_BYTES: u64 = 4 << 30;

/// Builds a backend over an adversarial scene, queries it, and prints the outcome in the format that
/// [`Outcome::read`] reads.
pub(crate) fn attempt(name: &str, adversary: &str, count: usize) -> Result<()> {
    let backend = crate::backends::ALL.iter().find(|b| b.name == name).context("a backend of the list")?;
    let scene = Scene::new(adversary.to_owned(), Adversary::named(adversary).soup(count))?;
    let queries = queries(&scene.double, QUERIES);
    let before = memory::current();
    let taken = catch(|| {
        let prepared = (backend.prepare)(&scene)?;
        memory::reset_peak();
        let (index, seconds) = thread_seconds(prepared.build);
        let index = index?;
        println!("build {seconds} {} {}", memory::peak() - before, memory::current() - before);
        let mut answers = vec![Answer::NONE; queries.len()];
        index.answer(Queries::new(queries.clone()).all(), &mut answers)?;
        Ok(answers)
    });
    match taken {
        Ok(answers) => {
            let soup = &*scene.double;
            let brute = BruteForce::new(soup).context("an adversary is finite")?;
            let wrong = queries.iter().zip(&answers).filter(|(query, answer)| {
                let nearest = brute.closest_point(*query).expect("there are primitives").primitive;
                let vertices: Vec<[f64; 3]> = soup.get(nearest).vertices().iter().map(|v| v.coords.into()).collect();
                let error = Truth::new(query.coords.into(), &vertices).error(answer.distance, 53, f64::from_bits(1));
                // An error that is not a number counts as infinite.
                error > ROUNDING
            });
            println!("wrong {}", wrong.count());
        }
        Err(Unavailable(why)) => println!("absent {why}"),
    }
    Ok(())
}

/// The outcome of a process.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Outcome {
    /// Seconds, the largest number of bytes at any time of the build, and the bytes of the index.
    pub(super) build: Option<(f64, usize, usize)>,
    /// The number of answers that are wrong by more than rounding.
    pub(super) wrong: Option<usize>,
    /// The reason why the process ended early.
    pub(super) end: Option<String>,
}

impl Outcome {
    /// Parses the text that [`attempt`] printed.
    fn read(printed: &str) -> Result<Self> {
        let mut outcome = Self::default();
        for line in printed.lines() {
            let (what, rest) = line.split_once(' ').context("a word and more")?;
            match what {
                "build" => {
                    let [seconds, peak, kept] = rest.split(' ').collect::<Vec<_>>()[..] else { bail!("three numbers") };
                    outcome.build = Some((seconds.parse()?, peak.parse()?, kept.parse()?));
                }
                "wrong" => outcome.wrong = Some(rest.parse()?),
                "absent" => outcome.end = Some(rest.to_owned()),
                _ => bail!("{what}?"),
            }
        }
        Ok(outcome)
    }

    /// Runs a command within the limits and parses its output.
    fn of(command: &mut Command, time_limit: Duration) -> Result<Self> {
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).stdin(Stdio::null()).spawn()?;
        let end = wait(&mut child, time_limit)?;
        let printed = std::io::read_to_string(child.stdout.take().context("it was piped")?)?;
        let outcome = Self::read(&printed)?;
        Ok(Self { end: outcome.end.clone().or(end), ..outcome })
    }

    /// Runs [`attempt`] in a new process of this program.
    pub(super) fn by_this_program(name: &str, adversary: &Adversary, count: usize) -> Result<Self> {
        let mut command = Command::new(std::env::current_exe()?);
        command.args(["rival", name, adversary.name, &count.to_string()]);
        Self::of(&mut command, TIME_LIMIT * u32::try_from(count.div_ceil(20_000))?)
    }
}

/// Waits for the end of a process and returns the reason of a bad end. A process that exceeds a limit is killed.
fn wait(child: &mut Child, time_limit: Duration) -> Result<Option<String>> {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok((!status.success()).then(|| in_words(status)));
        }
        let excess = if start.elapsed() > time_limit {
            Some(format!("no end in {} s", time_limit.as_secs()))
        } else if resident(child.id()).is_some_and(|bytes| bytes > MAX_RESIDENT_BYTES) {
            Some(format!("more than {} GiB", MAX_RESIDENT_BYTES >> 30))
        } else {
            None
        };
        if excess.is_some() {
            child.kill()?;
            child.wait()?;
            return Ok(excess);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[cfg(unix)]
fn in_words(status: ExitStatus) -> String {
    use std::os::unix::process::ExitStatusExt;
    match status.signal() {
        // Rust aborts with this signal when a stack overflows or no memory is left.
        Some(6) => "aborts: its stack overflows, or memory".to_owned(),
        Some(signal) => format!("ends by signal {signal}"),
        None => status.to_string(),
    }
}

#[cfg(not(unix))]
fn in_words(status: ExitStatus) -> String {
    status.to_string()
}

/// Returns the resident bytes of a process, on systems that report them as Linux does.
fn resident(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? << 10)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str, time_limit: Duration) -> Result<Outcome> {
        Outcome::of(Command::new("sh").args(["-c", script]), time_limit)
    }

    #[test]
    #[cfg(unix)]
    fn every_end_is_told() {
        let long = Duration::from_secs(60);
        let good = shell("echo build 0.5 100 50; echo wrong 3", long).unwrap();
        assert_eq!(good, Outcome { build: Some((0.5, 100, 50)), wrong: Some(3), end: None });
        let end = |script, time_limit| shell(script, time_limit).unwrap().end;
        assert_eq!(end("echo absent it panicked", long).as_deref(), Some("it panicked"));
        assert_eq!(end("kill -ABRT $$", long).as_deref(), Some("aborts: its stack overflows, or memory"));
        assert_eq!(end("kill -SEGV $$", long).as_deref(), Some("ends by signal 11"));
        assert_eq!(end("exec sleep 100", Duration::from_millis(50)).as_deref(), Some("no end in 0 s"));
        let late = shell("echo build 1 2 3; exec sleep 100", Duration::from_millis(500)).unwrap();
        assert!(late.build.is_some() && late.end.is_some());
        assert!(shell("echo nonsense there", long).is_err());
        assert!(resident(std::process::id()).is_none_or(|bytes| bytes > 1 << 20));
    }
}
