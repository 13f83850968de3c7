//! The scenes of the page: models of a folder, and scenes that are derived from them.

use super::profile::{Profile, Resolution};
use super::surfaces::{coarsened, fanned};
use crate::scene::Scene;
use anyhow::{Context, Result, bail};
use p2m_core::PrimitiveSet;
use p2m_mixed::generate::{
    Cylinder, IcoSphere, Sphere, Subdivide, TorusKnot, cylinder, gapped, ico_sphere, penetrating, sphere, subdivide,
    torus_knot,
};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The displacement of the middle of an edge in a subdivision, relative to the length of the edge.
const AMPLITUDE: f64 = 0.02;
/// The number of triangles in a triangulation of Table 4 for each triangle of the surface.
const PARTS: u32 = 16;

/// A folder of models.
pub(super) struct Models(pub(super) PathBuf);

impl Models {
    /// Returns an error that names the missing models, before anything is measured.
    pub(super) fn check(&self, profile: &Profile) -> Result<()> {
        let single = [profile.swept, profile.torn].into_iter().chain(profile.mixed);
        let lists = [profile.five, profile.long, profile.pairs, profile.scattered.unwrap_or_default()];
        let all = lists.into_iter().flatten().copied().chain(single);
        let missing: Vec<&str> = all.filter(|name| !is_made(name) && !self.0.join(name).is_file()).collect();
        if missing.is_empty() {
            return Ok(());
        }
        bail!("{} has no {}", self.0.display(), missing.join(", "))
    }

    /// Reads the model of that name.
    pub(super) fn read(&self, name: &str) -> Result<Scene> {
        let made = match name {
            "torus knot" => torus_knot(&TorusKnot { rings: 250, sides: 15, ..Default::default() })?,
            "cylinder" => cylinder(&Cylinder { sides: 75, bands: 25, cap_bands: 12 })?,
            _ => return Scene::read(&self.0.join(name)),
        };
        Scene::new(name.to_owned(), made)
    }

    /// Reads the model at a resolution.
    pub(super) fn at(&self, name: &str, resolution: Resolution) -> Result<Scene> {
        let model = self.read(name)?;
        let soup = match resolution {
            Resolution::Own => return Ok(model),
            Resolution::Coarsened(wanted) => coarsened(&model.double, wanted),
            Resolution::Subdivided(wanted) => {
                let options = Subdivide { amplitude: AMPLITUDE, ..Default::default() };
                subdivide(&coarsened(&model.double, wanted), &options)?
            }
        };
        Scene::new(format!("{} at {}", stem(name), soup.len()), soup)
    }

    /// Returns one surface in bad and in good triangles, about `wanted` of each and equally many.
    pub(super) fn pair(&self, name: &str, wanted: usize) -> Result<[Scene; 2]> {
        let surface = coarsened(&self.read(name)?.double, wanted / PARTS as usize);
        let good = subdivide(&surface, &Subdivide { levels: PARTS.ilog(4), ..Default::default() })?;
        let bad = fanned(&surface, PARTS);
        let name = stem(name);
        Ok([Scene::new(format!("{name}, bad"), bad)?, Scene::new(format!("{name}, good"), good)?])
    }

    /// Returns a surface as it is, and torn in two ways.
    pub(super) fn torn(&self, name: &str) -> Result<[Scene; 3]> {
        let own = Arc::unwrap_or_clone(self.read(name)?.double);
        let (apart, across) = (gapped(&own, 0.5)?, penetrating(&own, 5.0)?);
        let scenes = [("watertight", own), ("gapped", apart), ("penetrating", across)];
        let [a, b, c] = scenes.map(|(way, soup)| Scene::new(format!("{}, {way}", stem(name)), soup));
        Ok([a?, b?, c?])
    }

    /// Returns the scenes of Figures 20 to 22.
    pub(super) fn scattered(&self, profile: &Profile) -> Result<Vec<Scene>> {
        let names: Vec<String> = match profile.scattered {
            Some(names) => names.iter().map(|name| (*name).to_owned()).collect(),
            None => self.all()?,
        };
        let scenes: Result<Vec<Scene>> = names.iter().map(|name| self.read(name)).collect();
        Ok(scenes?.into_iter().filter(|scene| scene.len() >= profile.min_primitives).collect())
    }

    /// Returns the sorted names of all scenes in the folder.
    fn all(&self) -> Result<Vec<String>> {
        let folder = std::fs::read_dir(&self.0).with_context(|| self.0.display().to_string())?;
        let mut names = Vec::new();
        for entry in folder {
            let name = entry?.file_name().to_string_lossy().into_owned();
            if p2m_mixed::Format::from_path(Path::new(&name)).is_ok() {
                names.push(name);
            }
        }
        names.sort();
        Ok(names)
    }
}

/// Returns whether a scene of that name is generated.
fn is_made(name: &str) -> bool {
    Path::new(name).extension().is_none()
}

/// Returns a name without its extension.
pub(super) fn stem(name: &str) -> &str {
    Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or(name)
}

/// Returns spheres of about `triangles` triangles: one of meridians and parallels, and a subdivided icosahedron.
pub(super) fn spheres(triangles: u32) -> Result<[Scene; 2]> {
    let meridians = (triangles / 2).isqrt();
    let lines = sphere(&Sphere { meridians, bands: meridians + 1 })?;
    let even = ico_sphere(&IcoSphere { frequency: (triangles / 20).isqrt() })?;
    Ok([Scene::new("sphere of meridians".to_owned(), lines)?, Scene::new("sphere of an icosahedron".to_owned(), even)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::surfaces::quality;

    #[test]
    fn pairs_are_one_surface_with_as_many_triangles() {
        let models = Models(PathBuf::from("nowhere"));
        for name in ["torus knot", "cylinder"] {
            let size = p2m_testkit::amount(16_000, 4_000);
            let [bad, good] = models.pair(name, size as _).unwrap();
            assert_eq!(bad.len(), good.len());
            assert!(bad.len().abs_diff(size) < size / 4, "{}", bad.len());
            assert!(quality(&bad.double).0 * 3.0 < quality(&good.double).0);
        }
        assert!(models.pair("camel.off", 1000).is_err());
    }

    #[test]
    fn spheres_have_about_as_many_triangles() {
        for scene in spheres(20_000).unwrap() {
            assert!(scene.len().abs_diff(20_000) < 1_500, "{}", scene.describe());
        }
    }

    #[test]
    fn missing_models_are_named() {
        let error = Models(PathBuf::from("nowhere")).check(&super::super::profile::QUICK).unwrap_err().to_string();
        assert!(error.contains("nowhere has no camel.off") && !error.contains("torus"), "{error}");
    }
}
