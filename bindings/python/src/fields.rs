//! Distance fields on grids, and surfaces made of them.

use crate::errors::{grid_error, value_error};
use crate::index::Index;
use crate::scene::Scene;
use crate::work::{Run, run_owned};
use nalgebra::Point3;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use p2m_core::PrimitiveSet;
use p2m_field::grid_candidates::MAX_COORDINATE;
use p2m_field::{
    CandidateLists, FieldOptions, Grid, distances, distances_by_lists, offset_surface, signed_distances,
    signed_distances_by_lists,
};
use pyo3::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

#[pymethods]
impl Index {
    /// Returns the distances at the points of a grid, from the indices `first` on, with x running fastest.
    fn field<'py>(
        &self,
        py: Python<'py>,
        origin: [f64; 3],
        spacing: f64,
        first: [usize; 3],
        counts: [usize; 3],
        sign: Option<&str>,
        band: f64,
        run: Run,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let grid = Grid::new(Point3::from(origin), spacing, counts);
        let grid = grid.and_then(|grid| grid.part(first, counts)).map_err(grid_error)?;
        let signed = sign.map(|rule| self.signs(py, rule, run.0)).transpose()?;
        let (index, soup) = (self.any(), Arc::clone(&self.scene.soup));
        let values = run_owned(py, run, grid.len(), move |monitor| {
            let options = FieldOptions::default().with_band(band);
            let done = AtomicUsize::new(0);
            let report = |points: usize| {
                monitor.set_done(done.fetch_add(points, Ordering::Relaxed) + points);
                monitor.unwind_if_cancelled();
            };
            // Both methods return the same bits. Lists are faster on grids that are finer than the scene.
            let last = grid.point(grid.counts().map(|n| n - 1));
            let is_in_range = [grid.origin(), last].iter().flat_map(|p| p.iter()).all(|x| x.abs() <= MAX_COORDINATE);
            let has_lists = is_in_range && grid.len() >= soup.len();
            let lists = if has_lists { CandidateLists::new(&*soup) } else { None };
            match (&lists, &signed) {
                (Some(lists), Some(signed)) => signed_distances_by_lists(lists, signed, &grid, &options, &report),
                (Some(lists), None) => distances_by_lists(lists, &grid, &options, &report),
                (None, Some(signed)) => signed_distances(signed, &grid, &options, &report),
                (None, None) => distances(&*index, &grid, &options, &report),
            }
        })?;
        Ok(values.map_err(grid_error)?.into_pyarray(py))
    }

    /// Returns the surface at a distance in a field, with the errors of its vertices and triangles.
    fn offset_surface(
        &self,
        py: Python<'_>,
        origin: [f64; 3],
        spacing: f64,
        counts: [usize; 3],
        values: PyReadonlyArray1<'_, f32>,
        distance: f64,
        sign: Option<&str>,
        threads: usize,
    ) -> PyResult<(Scene, f64, f64)> {
        let grid = Grid::new(Point3::from(origin), spacing, counts).map_err(grid_error)?;
        let signed = sign.map(|rule| self.signs(py, rule, threads)).transpose()?;
        let (index, values) = (self.any(), values.as_slice()?.to_vec());
        let surface = run_owned(py, (threads, None), 1, move |_| {
            offset_surface(&grid, &values, distance, &|point| match &signed {
                Some(signed) => {
                    signed.closest_point(point).and_then(|found| Some((found.distance()?, found.closest.point)))
                }
                None => index.closest_point(point).map(|found| (found.distance, found.point)),
            })
        })?;
        let surface = surface.map_err(value_error)?;
        Ok((Scene::new(surface.soup.into()), surface.vertex_error, surface.triangle_error))
    }
}
