//! The list of all kinds of scenes.

use super::{
    CableBundle, Cone, Cylinder, GenerateError, IcoSphere, KnotAndCables, MixedSizes, SkewedGear, Sphere, TorusKnot,
    cable_bundle, cone, cylinder, ico_sphere, knot_and_cables, mixed_sizes, skewed_gear, sphere, torus_knot,
};
use p2m_core::Soup;

/// A kind of generated scene with its options.
///
/// ```
/// use p2m_mixed::generate::{Kind, Sphere};
///
/// for kind in Kind::all() {
///     println!("{:16} {}", kind.name(), kind.description());
/// }
/// assert_eq!(Kind::from_name("sphere"), Some(Kind::Sphere(Sphere::default())));
/// assert_eq!(Kind::Sphere(Sphere { bands: 40, ..Default::default() }).generate().unwrap().triangles().len(), 6240);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Kind {
    /// This is the scene of [`knot_and_cables`].
    KnotAndCables(KnotAndCables),
    /// This is the scene of [`torus_knot`].
    TorusKnot(TorusKnot),
    /// This is the scene of [`skewed_gear`].
    SkewedGear(SkewedGear),
    /// This is the scene of [`sphere`].
    Sphere(Sphere),
    /// This is the scene of [`ico_sphere`].
    IcoSphere(IcoSphere),
    /// This is the scene of [`cone`].
    Cone(Cone),
    /// This is the scene of [`cylinder`].
    Cylinder(Cylinder),
    /// This is the scene of [`cable_bundle`].
    CableBundle(CableBundle),
    /// This is the scene of [`mixed_sizes`].
    MixedSizes(MixedSizes),
}

impl Kind {
    /// Returns all kinds with their default options.
    #[must_use]
    pub fn all() -> [Self; 9] {
        [
            Self::KnotAndCables(KnotAndCables::default()),
            Self::TorusKnot(TorusKnot::default()),
            Self::SkewedGear(SkewedGear::default()),
            Self::Sphere(Sphere::default()),
            Self::IcoSphere(IcoSphere::default()),
            Self::Cone(Cone::default()),
            Self::Cylinder(Cylinder::default()),
            Self::CableBundle(CableBundle::default()),
            Self::MixedSizes(MixedSizes::default()),
        ]
    }

    /// Returns the kind of this name with its default options.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().into_iter().find(|kind| kind.name() == name)
    }

    /// Returns the name of the kind in tables and on the command line.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::KnotAndCables(_) => "knot-and-cables",
            Self::TorusKnot(_) => "torus-knot",
            Self::SkewedGear(_) => "skewed-gear",
            Self::Sphere(_) => "sphere",
            Self::IcoSphere(_) => "ico-sphere",
            Self::Cone(_) => "cone",
            Self::Cylinder(_) => "cylinder",
            Self::CableBundle(_) => "cable-bundle",
            Self::MixedSizes(_) => "mixed-sizes",
        }
    }

    /// Returns a description of the kind in a few words.
    #[must_use]
    pub fn description(&self) -> &'static str {
        match self {
            Self::KnotAndCables(_) => "a torus knot of triangles with cables of segments around it",
            Self::TorusKnot(_) => "a closed tube of triangles along a torus knot",
            Self::SkewedGear(_) => "a helical gear of thin triangles around the z axis",
            Self::Sphere(_) => "the unit sphere by latitude and longitude",
            Self::IcoSphere(_) => "the unit sphere as a subdivided icosahedron",
            Self::Cone(_) => "a closed cone around the z axis",
            Self::Cylinder(_) => "a closed cylinder around the z axis",
            Self::CableBundle(_) => "twisted strands of segments along a knot",
            Self::MixedSizes(_) => "triangles, segments and points of sizes over orders of magnitude",
        }
    }

    /// Generates the scene.
    ///
    /// # Errors
    /// [`GenerateError`] if an option is not in its range or there are more primitives than ids.
    pub fn generate(&self) -> Result<Soup<f64>, GenerateError> {
        match self {
            Self::KnotAndCables(options) => knot_and_cables(options),
            Self::TorusKnot(options) => torus_knot(options),
            Self::SkewedGear(options) => skewed_gear(options),
            Self::Sphere(options) => sphere(options),
            Self::IcoSphere(options) => ico_sphere(options),
            Self::Cone(options) => cone(options),
            Self::Cylinder(options) => cylinder(options),
            Self::CableBundle(options) => cable_bundle(options),
            Self::MixedSizes(options) => mixed_sizes(options),
        }
    }
}
