//! The arguments and the texts that pages share.

use crate::io::input::name;
use crate::io::is_standard;
use crate::page::up_axis::up_axes;
use p2m_core::Aabb;
use p2m_mixed::Scene;
use p2m_page::{UpAxis, View};
use std::path::Path;

#[derive(clap::Args)]
pub(crate) struct PageArgs {
    /// The axis that points up
    #[arg(long, value_parser = up_axes(), default_value = "z")]
    pub(crate) up: UpAxis,

    /// The name of the unit of length
    #[arg(long, value_name = "NAME", default_value = "units")]
    pub(crate) unit: String,
}

impl PageArgs {
    /// Starts a page of a scene, whose picture contains the box `around` as well.
    pub(crate) fn view<'a>(&self, scene: &'a Scene, around: &Aabb<f64>) -> View<'a> {
        View::new(scene, around).with_unit(&self.unit).with_up(self.up)
    }
}

/// Returns how a page was made: of which files, by which index, and by which rule of signs if there are signs.
pub(crate) fn about(files: &str, index: &str, rule: Option<&str>) -> String {
    let signs = rule.map(|rule| format!(", signs by the rule {rule}")).unwrap_or_default();
    format!("p2m {}, {files}, index {index}{signs}", env!("CARGO_PKG_VERSION"))
}

/// Returns the name of a file without its folder, or that of the standard input.
pub(crate) fn file_name(path: &Path) -> String {
    let file = path.file_name().filter(|_| !is_standard(path));
    file.map_or_else(|| name(path), |file| file.to_string_lossy().into_owned())
}
