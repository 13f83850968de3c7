//! `--backend`: what searches.

use crate::faces::{Faces, Used, WithTree};
use crate::progress::{Progress, Unit};
use crate::streams::Streams;
use clap::ValueEnum;
use clap::builder::PossibleValue;
use p2m_advisor::{Choice, Workload, recommend};
use p2m_bvh::AabbTree;
use p2m_bvh::{TreeIndex, Volume};
use p2m_core::storage::{self, Reader, Saved, Writer};
use p2m_core::{BruteForce, BuildIndex, CertifiedQuery, ClosestPoint, Inspect, RayQuery, Soup};
use p2m_interception::StageTimes;
use p2m_interception::{BuildStage, InterceptionIndex, Octree, OctreeReport, P2mReport, Partition, Voronoi};
use p2m_kdop::KdopTree;
use std::time::{Duration, Instant};

/// Backends that answer every kind of question.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Search {
    /// Every primitive, every time
    Brute,
    /// A tree of boxes
    Aabb,
    /// A tree of polytopes with --k faces, which fit closer what does not lie along the axes
    Kdop,
}

/// What they build.
pub(crate) trait Closest: ClosestPoint<f64> + CertifiedQuery<f64> + Inspect<f64> + Sync {
    /// Adds it to a file.
    fn save<'s>(&'s self, writer: &mut Writer<'s>);
}

/// The same for rays as well.
pub(crate) trait Index: Closest + RayQuery<f64> {}

impl<I: Closest + RayQuery<f64>> Index for I {}

impl<V: Volume> Closest for TreeIndex<f64, &Soup<f64>, V> {
    fn save<'s>(&'s self, writer: &mut Writer<'s>) {
        self.save(writer);
    }
}

impl<P: Partition + Saved + Sync> Closest for InterceptionIndex<f64, &Soup<f64>, P> {
    fn save<'s>(&'s self, writer: &mut Writer<'s>) {
        self.save(writer);
    }
}

impl Closest for BruteForce<&Soup<f64>> {
    /// There is nothing.
    fn save<'s>(&'s self, _: &mut Writer<'s>) {}
}

/// An index, and what there is to say about it.
pub(crate) struct Built<I> {
    pub(crate) index: I,
    pub(crate) about: About,
    /// Whether a file had it.
    pub(crate) loaded: bool,
    /// How long building took by stages, where there are some.
    pub(crate) stages: Stages,
}

/// The stages of a build, and how long they took.
pub(crate) type Stages = Vec<(BuildStage, Duration)>;

/// What there is to say about an index.
pub(crate) enum About {
    Nothing,
    /// Of a k-DOP tree.
    Faces(Used),
    /// Of an octree.
    Cubes(OctreeReport),
    /// Of a P2M index.
    Cells(P2mReport),
}

/// What to build over, or where to take it from.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    pub(crate) soup: &'a Soup<f64>,
    /// `None` for the usual ones.
    pub(crate) faces: Option<Faces>,
    /// The file that has the scene, which may have an index as well.
    pub(crate) saved: Option<&'a Reader>,
}

impl<'a> Source<'a> {
    /// The file, if it has an index that fits.
    fn with(self, fits: impl Fn(&str) -> bool) -> Option<&'a Reader> {
        self.saved.filter(|reader| storage::kind(reader).is_ok_and(|kind| fits(&kind)))
    }
}

impl Search {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Brute => "brute",
            Self::Aabb => "aabb",
            Self::Kdop => "kdop",
        }
    }

    /// The backend of the index that a file has, if it is one of these.
    pub(crate) fn of_saved(saved: Option<&Reader>) -> Option<Self> {
        match Backend::of_saved(saved) {
            Some(Backend::Search(search)) => Some(search),
            _ => None,
        }
    }

    /// The index of the file, or a new one.
    pub(crate) fn build<'a>(self, streams: &Streams, source: Source<'a>) -> anyhow::Result<Built<Box<dyn Index + 'a>>> {
        let soup = source.soup;
        let progress = Progress::start(streams, "building the index", None, Unit::None);
        let built: Built<Box<dyn Index + 'a>> = match self {
            Self::Brute => Built {
                index: Box::new(BruteForce::build(soup, &())?),
                about: About::Nothing,
                loaded: false,
                stages: Stages::new(),
            },
            Self::Aabb => {
                let saved = source.with(|kind| kind == self.name());
                let index: AabbTree<f64, _> = match saved {
                    Some(reader) => AabbTree::load(soup, reader)?,
                    None => AabbTree::build(soup, &Default::default())?,
                };
                Built { index: Box::new(index), about: About::Nothing, loaded: saved.is_some(), stages: Stages::new() }
            }
            Self::Kdop => {
                let saved = source.saved.and_then(|r| Faces::of_saved(source.faces, r).map(|k| (r, k)));
                let (index, used) = match saved {
                    Some((reader, k)) => Faces::load(k, soup, reader, AnyTree)?,
                    None => source.faces.unwrap_or(Faces::Fourteen).build(soup, AnyTree)?,
                };
                Built { index, about: About::Faces(used), loaded: saved.is_some(), stages: Stages::new() }
            }
        };
        drop(progress);
        Ok(built)
    }
}

/// A k-DOP tree as an index.
struct AnyTree;

impl<'a> WithTree<'a> for AnyTree {
    type Output = Box<dyn Index + 'a>;
    fn with<const K: usize>(self, tree: KdopTree<f64, &'a Soup<f64>, K>) -> Self::Output {
        Box::new(tree)
    }
}

/// All backends.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Backend {
    Search(Search),
    Octree,
    P2m,
}

impl ValueEnum for Backend {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: &[Backend] = &[
            Backend::Search(Search::Brute),
            Backend::Search(Search::Aabb),
            Backend::Search(Search::Kdop),
            Backend::Octree,
            Backend::P2m,
        ];
        ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let octree =
            "Cells in space with lists of what can be nearest there: no search, for more memory and a longer build";
        let p2m = "Cells of the vertices with lists of what can be nearest there: fastest far from the scene";
        match self {
            Self::Search(search) => search.to_possible_value(),
            Self::Octree => Some(PossibleValue::new(self.name()).help(octree)),
            Self::P2m => Some(PossibleValue::new(self.name()).help(p2m)),
        }
    }
}

/// What a user asks for: a backend, or to choose one.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wanted {
    Named(Backend),
    Auto,
}

impl ValueEnum for Wanted {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: &[Wanted] = &[
            Wanted::Named(Backend::Search(Search::Brute)),
            Wanted::Named(Backend::Search(Search::Aabb)),
            Wanted::Named(Backend::Search(Search::Kdop)),
            Wanted::Named(Backend::Octree),
            Wanted::Named(Backend::P2m),
            Wanted::Auto,
        ];
        ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self {
            Self::Named(backend) => backend.to_possible_value(),
            Self::Auto => {
                Some(PossibleValue::new("auto").help("The one that `p2m advise` recommends for so many queries"))
            }
        }
    }
}

impl Wanted {
    /// The backend that was named, that of the file if there is one with an index, or that which is advised.
    pub(crate) fn resolve(
        wanted: Option<Self>,
        saved: Option<&Reader>,
        soup: &Soup<f64>,
        workload: &Workload<'_>,
    ) -> anyhow::Result<Backend> {
        match wanted {
            Some(Self::Named(backend)) => Ok(backend),
            None => Ok(Backend::of_saved(saved).unwrap_or(Backend::Search(Search::Aabb))),
            Some(Self::Auto) => Ok(match recommend(soup, workload)?.choice() {
                Choice::Brute => Backend::Search(Search::Brute),
                Choice::Aabb => Backend::Search(Search::Aabb),
                Choice::Kdop => Backend::Search(Search::Kdop),
                Choice::Octree => Backend::Octree,
                Choice::P2m => Backend::P2m,
            }),
        }
    }
}

impl Backend {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Search(search) => search.name(),
            Self::Octree => "octree",
            Self::P2m => "p2m",
        }
    }

    /// The backend of the index that a file has.
    pub(crate) fn of_saved(saved: Option<&Reader>) -> Option<Self> {
        let reader = saved?;
        if Faces::of_saved(None, reader).is_some() {
            return Some(Self::Search(Search::Kdop));
        }
        let kind = storage::kind(reader).ok()?;
        Self::value_variants().iter().find(|backend| backend.name() == kind).copied()
    }

    /// The index of the file, or a new one.
    pub(crate) fn build<'a>(
        self,
        streams: &Streams,
        source: Source<'a>,
    ) -> anyhow::Result<Built<Box<dyn Closest + 'a>>> {
        match self {
            Self::Search(search) => {
                let Built { index, about, loaded, stages } = search.build(streams, source)?;
                Ok(Built { index, about, loaded, stages })
            }
            Self::Octree => interception::<Octree>(streams, source, About::Cubes),
            Self::P2m => interception::<Voronoi>(streams, source, About::Cells),
        }
    }
}

/// An interception index, which takes a while to build.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part is from 0 to 1")]
fn interception<'a, P: Partition + Saved + Sync + 'static>(
    streams: &Streams,
    source: Source<'a>,
    about: fn(P::Report) -> About,
) -> anyhow::Result<Built<Box<dyn Closest + 'a>>> {
    let saved = source.with(|kind| kind == P::kind());
    let start = Instant::now();
    let times = StageTimes::new(move || start.elapsed());
    let index: InterceptionIndex<f64, _, P> = if let Some(reader) = saved {
        InterceptionIndex::load(source.soup, reader)?
    } else {
        let bar = Progress::start(streams, "finding cells", Some(100), Unit::Percent);
        InterceptionIndex::build_with_progress(source.soup, &Default::default(), &|progress| {
            times.tell(progress);
            bar.reach((progress.part * 100.0) as u64);
        })?
    };
    let report = index.report();
    Ok(Built { index: Box::new(index), about: about(report), loaded: saved.is_some(), stages: times.finish() })
}
