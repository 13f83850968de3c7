//! The list of all kinds of scenes.

use super::{
    CableBundle, Cone, Cylinder, GenerateError, IcoSphere, KnotAndCables, MixedSizes, SkewedGear, Sphere, TorusKnot,
    cable_bundle, cone, cylinder, ico_sphere, knot_and_cables, mixed_sizes, skewed_gear, sphere, torus_knot,
};
use p2m_core::Soup;

/// Generates [`Kind`] from a table, whose rows have the name of a kind, the function that makes it, and a description.
macro_rules! kinds {
    ($($options:ident = $name:literal, $generate:ident, $description:literal;)*) => {
        /// A kind of generated scene with its options.
        ///
        /// ```
        /// use p2m_mixed::generate::{Kind, Sphere};
        ///
        /// for kind in Kind::all() {
        ///     println!("{:16} {}", kind.name(), kind.description());
        /// }
        /// assert_eq!(Kind::from_name("sphere"), Some(Kind::Sphere(Sphere::default())));
        /// let sphere = Kind::Sphere(Sphere { bands: 40, ..Default::default() });
        /// assert_eq!(sphere.generate().unwrap().triangles().len(), 6240);
        /// ```
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[non_exhaustive]
        pub enum Kind {
            $(
                #[doc = concat!("This is the scene of [`", stringify!($generate), "`].")]
                $options($options),
            )*
        }

        impl Kind {
            /// Returns all kinds with their default options.
            #[must_use]
            pub fn all() -> [Self; 9] {
                [$(Self::$options($options::default())),*]
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
                    $(Self::$options(_) => $name,)*
                }
            }

            /// Returns a description of the kind in a few words.
            #[must_use]
            pub fn description(&self) -> &'static str {
                match self {
                    $(Self::$options(_) => $description,)*
                }
            }

            /// Generates the scene.
            ///
            /// # Errors
            /// [`GenerateError`] if an option is not in its range or there are more primitives than ids.
            pub fn generate(&self) -> Result<Soup<f64>, GenerateError> {
                match self {
                    $(Self::$options(options) => $generate(options),)*
                }
            }
        }
    };
}

kinds! {
    KnotAndCables = "knot-and-cables", knot_and_cables, "a torus knot of triangles with cables of segments around it";
    TorusKnot = "torus-knot", torus_knot, "a closed tube of triangles along a torus knot";
    SkewedGear = "skewed-gear", skewed_gear, "a helical gear of thin triangles around the z axis";
    Sphere = "sphere", sphere, "the unit sphere by latitude and longitude";
    IcoSphere = "ico-sphere", ico_sphere, "the unit sphere as a subdivided icosahedron";
    Cone = "cone", cone, "a closed cone around the z axis";
    Cylinder = "cylinder", cylinder, "a closed cylinder around the z axis";
    CableBundle = "cable-bundle", cable_bundle, "twisted strands of segments along a knot";
    MixedSizes = "mixed-sizes", mixed_sizes, "triangles, segments and points of sizes over orders of magnitude";
}
