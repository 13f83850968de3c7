//! Pages that show two scenes, and lines between them or how one was moved.

use crate::io::{Output, Streams, usage};
use crate::page::open::OpenArgs;
use crate::page::source::{PageArgs, about, file_name};
use anyhow::Context;
use nalgebra::{Isometry3, Point3};
use p2m_core::pair::Motion;
use p2m_core::{Aabb, Element, PrimitiveSet, Soup};
use p2m_mixed::{Object, Scene};
use p2m_page::{Measure, Moved};
use std::path::{Path, PathBuf};

/// The arguments of commands that can write a page about two scenes.
#[derive(clap::Args)]
pub(crate) struct PairPageArgs {
    /// Write a page that shows the scenes and what was found
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,

    #[command(flatten)]
    page: PageArgs,

    #[command(flatten)]
    open: OpenArgs,
}

/// The content of a page about two scenes.
pub(crate) struct PairPage<'a> {
    pub(crate) paths: [&'a Path; 2],
    pub(crate) scenes: [&'a Scene; 2],
    /// The motion of the second scene, if it is not in its place yet.
    pub(crate) motion: Option<&'a Isometry3<f64>>,
    pub(crate) title: &'static str,
    pub(crate) verdict: String,
    /// Sentences on what the verdict means, and on reasons to doubt it.
    pub(crate) remarks: Vec<String>,
    pub(crate) found: PairResult,
}

/// The result of a comparison of two scenes.
pub(crate) enum PairResult {
    /// Lines between them.
    Measures(Vec<Measure>),
    /// How the second scene was moved onto the first one, and the box in which it was before.
    Moved { moved: Moved, before: Aabb<f64> },
}

impl PairPageArgs {
    /// The name of the unit of lengths.
    pub(crate) fn unit(&self) -> &str {
        &self.page.unit
    }

    /// Refuses a page that would replace a scene, and `--open` without a page.
    pub(crate) fn check(&self, inputs: &[&Path]) -> anyhow::Result<()> {
        match &self.html {
            Some(html) => Output::refuse_inputs(html, inputs),
            None if self.open.open => Err(usage("--open needs a page: --html FILE")),
            None => Ok(()),
        }
    }

    /// Writes the page, if one was asked for.
    pub(crate) fn write<'a>(&self, streams: &Streams, page: impl FnOnce() -> PairPage<'a>) -> anyhow::Result<()> {
        let Some(html) = &self.html else { return Ok(()) };
        let PairPage { paths, scenes, motion, title, verdict, remarks, found } = page();
        let names = paths.map(file_name);
        let both = joined(&names, scenes, motion).context("the page")?;
        let view = |around: &Aabb<f64>| self.page.view(&both, around).with_object_colours();
        let mut view = match found {
            PairResult::Measures(measures) => {
                let ends: Vec<Point3<f64>> = measures.iter().flat_map(|measure| measure.ends).collect();
                view(&Aabb::from_points(&ends)).with_measures(title, &verdict, &remarks, &measures)
            }
            PairResult::Moved { moved, before } => view(&before).with_moved(title, &verdict, &remarks, &moved),
        };
        view.title = format!("{} and {}", names[0], names[1]);
        view.summary = verdict;
        view.about = about(&format!("scenes {} and {}", names[0], names[1]), "aabb", None);
        Output::open(streams, Some(html))?.finish_with(&view.html()?)?;
        streams.print_summary(format_args!("written  {}\n", html.display()));
        self.open.show(Some(html))
    }
}

/// Returns a scene of two, each of which is an object.
fn joined(names: &[String; 2], scenes: [&Scene; 2], motion: Option<&Isometry3<f64>>) -> anyhow::Result<Scene> {
    let (mut positions, mut elements, mut objects) = (Vec::new(), Vec::new(), Vec::new());
    let motion = motion.map(Motion::new);
    for (k, (name, scene)) in names.iter().zip(scenes).enumerate() {
        let (shift, first) = (u32::try_from(positions.len())?, elements.len());
        let moved = |p: &Point3<f64>| match &motion {
            Some(motion) if k == 1 => motion.apply(p.coords.into()).into(),
            _ => *p,
        };
        positions.extend(scene.soup.positions().iter().map(moved));
        elements.extend(scene.soup.elements().map(|element| match element {
            Element::Point(i) => Element::Point(i + shift),
            Element::Segment(ends) => Element::Segment(ends.map(|i| i + shift)),
            Element::Triangle(corners) => Element::Triangle(corners.map(|i| i + shift)),
        }));
        objects.push(Object { name: name.clone(), ids: first..first + scene.soup.len() });
    }
    let mut both = Scene::from(Soup::new(positions, elements)?);
    both.objects = objects;
    Ok(both)
}
