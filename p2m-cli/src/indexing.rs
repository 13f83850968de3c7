//! What is indexed and how, as the commands are told that are about an index.

use crate::backend::{Backend, Search};
use crate::faces::{self, Faces};
use crate::input::SceneArgs;
use p2m_core::saved::Reader;

#[derive(clap::Args)]
pub(crate) struct Indexing {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,

    /// Which index [default: aabb, or for `stats` that of a saved file]
    #[arg(long, value_enum)]
    backend: Option<Backend>,

    /// How many faces the polytopes of --backend kdop have [default: 14]
    #[arg(long, value_name = "K", value_enum, ignore_case = true, allow_negative_numbers = true)]
    k: Option<Faces>,
}

impl Indexing {
    /// The backend: the one that was named, or of the file if there is one with an index; and the faces of k-DOPs.
    ///
    /// # Errors
    /// For faces and another backend than k-DOPs.
    pub(crate) fn choice(&self, saved: Option<&Reader>) -> anyhow::Result<(Backend, Option<Faces>)> {
        let backend = self.backend.or_else(|| Backend::of_saved(saved)).unwrap_or(Backend::Search(Search::Aabb));
        Ok((backend, faces::only_for(backend == Backend::Search(Search::Kdop), self.k)?))
    }
}
