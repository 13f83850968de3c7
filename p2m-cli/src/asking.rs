//! How `query` and `ray` ask: the options that they share, and many questions at once.

use crate::faces::Faces;
use crate::input::{SceneArgs, is_standard, or_option};
use crate::output::Output;
use crate::progress::{Progress, Unit};
use crate::streams::Streams;
use crate::usage::{one_of, usage};
use anyhow::anyhow;
use p2m_mixed::AnswerFormat;
use rayon::ThreadPool;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

#[derive(clap::Args)]
pub(crate) struct Asking {
    /// How many faces the polytopes of --backend kdop have [default: 14, or as a saved index]
    #[arg(long, value_name = "K", value_enum, ignore_case = true, allow_negative_numbers = true)]
    pub(crate) k: Option<Faces>,

    /// Where to write the answers; `-` is the standard output.
    ///
    /// The file appears under this name when it is complete, and does not if the run is interrupted (one that is ended
    /// by SIGKILL leaves a file `.p2m-*` beside it). A link is followed, one to nothing is refused, and so is the
    /// name of an input.
    #[arg(long, value_name = "FILE", default_value = "-")]
    pub(crate) out: PathBuf,

    /// The format of the answers, if the extension of their file does not tell; CSV is the default
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<AnswerFormat>(AnswerFormat::NAMES), ignore_case = true)]
    out_format: Option<AnswerFormat>,

    /// Report the summary as one JSON object on the standard output; needs --out FILE
    #[arg(long)]
    pub(crate) json: bool,

    /// How many threads to use, up to 1024; all cores by default
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    threads: Option<u16>,
}

impl Asking {
    /// Refuses what cannot be, before any work: `file` has the questions, which are called `what`.
    pub(crate) fn check(&self, scene: &SceneArgs, file: Option<&Path>, what: &str) -> anyhow::Result<()> {
        if self.json && is_standard(&self.out) {
            return Err(usage(
                "--json reports on the standard output, so the answers have to go to a file: add --out FILE",
            ));
        }
        if is_standard(&scene.path) && file.is_some_and(is_standard) {
            return Err(usage(format!("the standard input cannot be both the scene and the {what}")));
        }
        let inputs: Vec<&Path> = std::iter::once(scene.path.as_path()).chain(file).collect();
        Output::refuse_inputs(&self.out, &inputs)
    }

    /// The format of the answers: the given one, or that of the extension; CSV for names that have none.
    pub(crate) fn format(&self, streams: &Streams) -> anyhow::Result<AnswerFormat> {
        let format = match self.out_format {
            Some(format) => format,
            None if is_standard(&self.out) || self.out.extension().is_none() => AnswerFormat::Csv,
            None => AnswerFormat::from_path(&self.out).map_err(|e| or_option(&e, "--out-format"))?,
        };
        if format != AnswerFormat::Csv {
            Output::refuse_terminal(streams, &self.out, format.name())?;
        }
        Ok(format)
    }

    /// The threads.
    pub(crate) fn pool(&self) -> anyhow::Result<ThreadPool> {
        pool(self.threads)
    }

    /// The file of the answers, for the report.
    pub(crate) fn written(&self, format: AnswerFormat, bytes: u64) -> Value {
        json!({ "file": self.out.display().to_string(), "format": format.name(), "bytes": bytes })
    }
}

/// So many threads, or as many as there are cores.
pub(crate) fn pool(threads: Option<u16>) -> anyhow::Result<ThreadPool> {
    let threads = threads.map_or(0, usize::from); // 0 is all of them
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|e| anyhow!("cannot start threads: {e}")) // as text: its source says the same again
}

/// Questions that are asked before their answers are written: enough to keep all threads busy, few enough to hold.
const CHUNK: usize = 1 << 14;
/// Questions that one thread takes at a time. A brute-force query of a large scene takes milliseconds.
const SHARE: usize = 32;

/// So many questions, made as they are needed.
pub(crate) struct Questions<I> {
    /// What they are called.
    pub(crate) name: &'static str,
    pub(crate) count: u64,
    pub(crate) iter: I,
}

/// Asks chunk by chunk on all threads, and hands on every question with its answer, in order; how long the asking took.
pub(crate) fn ask<Q: Sync, A: Clone + Default + Send>(
    streams: &Streams,
    pool: &ThreadPool,
    mut questions: Questions<impl Iterator<Item = Q>>,
    answer: impl Fn(&[Q], &mut [A]) + Sync,
    mut take: impl FnMut(&Q, &A) -> io::Result<()>,
) -> io::Result<Duration> {
    let progress = Progress::start(streams, "asking", Some(questions.count), Unit::Items(questions.name));
    let mut time = Duration::ZERO;
    let (mut chunk, mut answers) = (Vec::new(), Vec::new());
    loop {
        chunk.clear();
        chunk.extend(questions.iter.by_ref().take(CHUNK));
        if chunk.is_empty() {
            return Ok(time);
        }
        answers.clear();
        answers.resize(chunk.len(), A::default());
        let start = Instant::now();
        pool.install(|| {
            chunk.par_chunks(SHARE).zip(answers.par_chunks_mut(SHARE)).for_each(|(questions, answers)| {
                answer(questions, answers);
                progress.add(questions.len() as u64);
            });
        });
        time += start.elapsed();
        for (question, answer) in chunk.iter().zip(&answers) {
            take(question, answer)?;
        }
    }
}
