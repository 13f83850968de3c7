//! The arguments that `query` and `ray` share.

use crate::answers::table::AnswerFormat;
use crate::index::kdop_faces;
use crate::io::input::or_option;
use crate::io::usage::{one_of, usage};
use crate::io::{Output, SceneArgs, Streams, ThreadArgs, is_standard, shown};
use p2m_backends::KdopDirections;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct QueryArgs {
    /// The number of faces of k-DOPs, for --backend kdop [default: the saved index, or 14]
    #[arg(long, value_name = "K", value_parser = kdop_faces(), ignore_case = true, allow_negative_numbers = true)]
    pub(crate) k: Option<KdopDirections>,

    /// Write the answers to this file; `-` is the standard output
    ///
    /// The file appears under this name when it is complete. An interrupted run leaves nothing behind, except after
    /// SIGKILL, which leaves a file `.p2m-*`. Symbolic links are followed. Dangling links, and files that are also
    /// inputs, are refused.
    #[arg(long, value_name = "FILE", default_value = "-")]
    pub(crate) out: PathBuf,

    /// The format of the answers [default: by the file extension, or else CSV]
    #[arg(long, value_name = "FORMAT", value_parser = one_of::<AnswerFormat>(AnswerFormat::NAMES), ignore_case = true)]
    out_format: Option<AnswerFormat>,

    /// Print the summary as JSON; needs --out FILE
    #[arg(long)]
    pub(crate) json: bool,

    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
}

impl QueryArgs {
    /// Refuses impossible combinations of arguments before any work. `file` has the queries, which messages call
    /// `what`.
    pub(crate) fn check(&self, scene: &SceneArgs, file: Option<&Path>, what: &str) -> anyhow::Result<()> {
        Output::refuse_report(self.json, &self.out, "the answers have to go to a file: add --out FILE")?;
        if is_standard(&scene.path) && file.is_some_and(is_standard) {
            return Err(usage(format!("the standard input cannot be both the scene and the {what}")));
        }
        let inputs: Vec<&Path> = std::iter::once(scene.path.as_path()).chain(file).collect();
        Output::refuse_inputs(&self.out, &inputs)
    }

    /// Returns the format of the answers: the given one, or else that of the extension, or CSV without an extension.
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

    /// Returns the part of a report about the file of the answers.
    pub(crate) fn output_json(&self, format: AnswerFormat, bytes: u64) -> Value {
        json!({ "file": shown(&self.out), "format": format.name(), "bytes": bytes })
    }
}
