//! Rivals over adversaries, each in a process of its own: stacks that overflow, builds without end and memory without bound
//! end that process and are a row of the table.

use crate::contender::{Absent, Answer, catch};
use crate::extremes::tally::ROUNDING;
use crate::memory;
use crate::queries::Queries;
use crate::scene::Scene;
use anyhow::{Context, Result, bail};
use cpu_time::ThreadTime;
use p2m_core::{BruteForce, ClosestPoint, PrimitiveSet};
use p2m_testkit::adversaries::{Adversary, queries};
use p2m_testkit::truth::Truth;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Who is asked, by names of the list of contenders.
pub(super) const RIVALS: [&str; 2] = ["parry3d-f64", "bvh"];
/// How long a process may take for a scene of 20,000 primitives; more have more.
pub(super) const PATIENCE: Duration = Duration::from_secs(60);
/// Bytes that a process may hold, where the system tells.
const MEMORY: u64 = 4 << 30;

/// Builds a rival over an adversary and asks it, and prints what came of it in words that [`Outcome::read`] reads.
pub(crate) fn attempt(name: &str, adversary: &str, count: usize) -> Result<()> {
    let backend = crate::backends::ALL.iter().find(|b| b.name == name).context("a contender of the list")?;
    let scene = Scene::new(adversary.to_owned(), Adversary::named(adversary).soup(count))?;
    let queries = queries(&scene.double, super::QUERIES);
    let before = memory::current();
    let taken = catch(|| {
        let prepared = (backend.prepare)(&scene)?;
        memory::reset_peak();
        let start = ThreadTime::now();
        let index = (prepared.build)()?;
        let seconds = start.elapsed().as_secs_f64();
        println!("build {seconds} {} {}", memory::peak() - before, memory::current() - before);
        let mut answers = vec![Answer::NONE; queries.len()];
        index.answer(Queries::new(queries.clone()).all(), &mut answers)?;
        Ok(answers)
    });
    match taken {
        Ok(answers) => {
            let soup = &scene.double;
            let brute = BruteForce::new(soup).context("an adversary is finite")?;
            let wrong = queries.iter().zip(&answers).filter(|(query, answer)| {
                let nearest = brute.closest_point(*query).expect("there are primitives").primitive;
                let vertices: Vec<[f64; 3]> = soup.get(nearest).vertices().iter().map(|v| v.coords.into()).collect();
                let error = Truth::new(query.coords.into(), &vertices).error(answer.distance, 53, f64::from_bits(1));
                // What is no number is infinitely wrong.
                error > ROUNDING
            });
            println!("wrong {}", wrong.count());
        }
        Err(Absent(why)) => println!("absent {why}"),
    }
    Ok(())
}

/// What came of it.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Outcome {
    /// Seconds, bytes at a time while building, bytes of the index.
    pub(super) build: Option<(f64, usize, usize)>,
    /// Answers that are off by more than rounding.
    pub(super) wrong: Option<usize>,
    /// Why there is no more.
    pub(super) end: Option<String>,
}

impl Outcome {
    /// From what [`attempt`] printed.
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

    /// What a program says that is started for it, within limits.
    fn of(command: &mut Command, patience: Duration) -> Result<Self> {
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).stdin(Stdio::null()).spawn()?;
        let end = wait(&mut child, patience)?;
        let printed = std::io::read_to_string(child.stdout.take().context("it was piped")?)?;
        let outcome = Self::read(&printed)?;
        Ok(Self { end: outcome.end.clone().or(end), ..outcome })
    }

    /// The same scene and rival as [`attempt`], by this program.
    pub(super) fn by_this_program(name: &str, adversary: &Adversary, count: usize) -> Result<Self> {
        let mut command = Command::new(std::env::current_exe()?);
        command.args(["rival", name, adversary.name, &count.to_string()]);
        Self::of(&mut command, PATIENCE * u32::try_from(count.div_ceil(20_000))?)
    }
}

/// Waits for the end; `None` if it was a good one. A process that takes too much is killed.
fn wait(child: &mut Child, patience: Duration) -> Result<Option<String>> {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok((!status.success()).then(|| in_words(status)));
        }
        let excess = if start.elapsed() > patience {
            Some(format!("no end in {} s", patience.as_secs()))
        } else if resident(child.id()).is_some_and(|bytes| bytes > MEMORY) {
            Some(format!("more than {} GiB", MEMORY >> 30))
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
        // What Rust ends with when a stack overflows or no memory is left.
        Some(6) => "aborts: its stack overflows, or memory".to_owned(),
        Some(signal) => format!("ends by signal {signal}"),
        None => status.to_string(),
    }
}

#[cfg(not(unix))]
fn in_words(status: ExitStatus) -> String {
    status.to_string()
}

/// Bytes of a process in memory, where the system tells as Linux does.
fn resident(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? << 10)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str, patience: Duration) -> Result<Outcome> {
        Outcome::of(Command::new("sh").args(["-c", script]), patience)
    }

    #[test]
    #[cfg(unix)]
    fn every_end_is_told() {
        let long = Duration::from_secs(60);
        let good = shell("echo build 0.5 100 50; echo wrong 3", long).unwrap();
        assert_eq!(good, Outcome { build: Some((0.5, 100, 50)), wrong: Some(3), end: None });
        let end = |script, patience| shell(script, patience).unwrap().end;
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
