//! Pages that show a scene.

use crate::errors::value_error;
use crate::scene::Scene;
use numpy::PyReadonlyArray1;
use p2m_core::{Aabb, PrimitiveSet};
use p2m_field::Grid;
use p2m_page::{UpAxis, View};
use pyo3::prelude::*;

/// The origin, the spacing and the counts of a grid.
type GridParts = ([f64; 3], f64, [usize; 3]);

/// The name and version of the program that makes pages and reports.
pub(crate) const ABOUT: &str = concat!("p2m ", env!("CARGO_PKG_VERSION"), " for Python");

/// Returns the axis that points up.
pub(crate) fn up_axis(is_y_up: bool) -> UpAxis {
    if is_y_up { UpAxis::Y } else { UpAxis::Z }
}

/// Returns a view as HTML, with a title, a summary and a unit.
pub(crate) fn page(view: View<'_>, (title, summary, unit): (String, String, &str), is_y_up: bool) -> PyResult<String> {
    let mut view = view.with_unit(unit).with_up(up_axis(is_y_up));
    (view.title, view.summary, view.about) = (title, summary, ABOUT.to_owned());
    view.html().map_err(value_error)
}

/// Returns a grid over the box of a scene, scaled about its centre, with `resolution` points along the longest side.
#[pyfunction]
pub(crate) fn grid_around(scene: &Scene, resolution: usize, scale: f64) -> PyResult<GridParts> {
    let grid = Grid::around(&scene.shared.soup.aabb(), resolution, scale).map_err(value_error)?;
    Ok((grid.origin().coords.into(), grid.spacing(), grid.counts()))
}

/// Returns a grid that contains all points at a distance from anything inside of the box of a scene.
#[pyfunction]
pub(crate) fn grid_of_offset(scene: &Scene, distance: f64, resolution: usize) -> PyResult<GridParts> {
    let grid = p2m_field::offset_grid(&scene.shared.soup.aabb(), distance, resolution).map_err(value_error)?;
    Ok((grid.origin().coords.into(), grid.spacing(), grid.counts()))
}

/// Returns a page that shows a scene, as HTML. `texts` has the title, the summary and the unit. A field has the values
/// of a grid, with x running fastest.
#[pyfunction]
pub(crate) fn scene_page(
    scene: &Scene,
    texts: [String; 3],
    is_y_up: bool,
    is_live: bool,
    field: Option<(GridParts, PyReadonlyArray1<'_, f32>)>,
) -> PyResult<String> {
    let [title, summary, unit] = texts;
    let field = field.map(|((origin, spacing, counts), values)| {
        Ok::<_, PyErr>((Grid::new(origin.into(), spacing, counts).map_err(value_error)?, values))
    });
    let field = field.transpose()?;
    let mut around = Aabb::empty();
    if let Some((grid, _)) = &field {
        around = around.union(&Aabb { min: grid.origin(), max: grid.point(grid.counts().map(|n| n - 1)) });
    }
    let mut view = View::new(&scene.shared, &around);
    if is_live {
        view = view.with_live_queries();
    }
    if let Some((grid, values)) = &field {
        view = view.with_field(grid, values.as_slice()?);
    }
    page(view, (title, summary, &unit), is_y_up)
}
