//! What is indexed and how, as the commands are told that are about an index.

use crate::backend::{Backend, Search, Wanted};
use crate::faces::{self, Faces};
use crate::input::SceneArgs;
use p2m_advisor::{Place, Workload};
use p2m_core::Soup;
use p2m_core::storage::Reader;

#[derive(clap::Args)]
pub(crate) struct Indexing {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,

    /// Which index [default: aabb, or for `stats` that of a saved file]
    #[arg(long, value_enum)]
    backend: Option<Wanted>,

    /// How many faces the polytopes of --backend kdop have [default: 14]
    #[arg(long, value_name = "K", value_enum, ignore_case = true, allow_negative_numbers = true)]
    k: Option<Faces>,
}

/// Queries that an index is taken to be built for, if nothing says how many.
pub(crate) const MANY: u64 = 10_000_000;

impl Indexing {
    /// Refuses faces for another backend than k-DOPs, as far as that is known before any work.
    pub(crate) fn check(&self) -> anyhow::Result<()> {
        let is_kdop = matches!(self.backend, Some(Wanted::Auto | Wanted::Named(Backend::Search(Search::Kdop))));
        faces::only_for(is_kdop, self.k).map(|_| ())
    }

    /// Whether there will be no index.
    pub(crate) fn is_brute(&self) -> bool {
        self.backend == Some(Wanted::Named(Backend::Search(Search::Brute)))
    }

    /// Whether neither an index nor faces were named.
    pub(crate) fn is_open(&self) -> bool {
        matches!(self.backend, None | Some(Wanted::Auto)) && self.k.is_none()
    }

    /// The backend: the one that was named, or of the file if there is one with an index, or for so many queries in the
    /// box; and the faces of k-DOPs.
    ///
    /// # Errors
    /// For faces and another backend than k-DOPs.
    pub(crate) fn choice(
        &self,
        saved: Option<&Reader>,
        soup: &Soup<f64>,
        queries: u64,
    ) -> anyhow::Result<(Backend, Option<Faces>)> {
        let backend = Wanted::resolve(self.backend, saved, soup, &Workload::new(queries, Place::Box))?;
        Ok((backend, faces::only_for(backend == Backend::Search(Search::Kdop), self.k)?))
    }
}
