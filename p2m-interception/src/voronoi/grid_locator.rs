//! The default locator: a grid whose cells store the site nearest to their centre.
//!
//! One grid lies around the scene. Its cells with several sites are divided into 64 finer cells. A coarser grid covers
//! the whole domain.

use crate::voronoi::locator::LocatorSites;
use crate::voronoi::neighbours::NeighbourTable;
use p2m_core::engine::simd::{InstructionSet, SimdKernel, prefetch};
use p2m_core::engine::vector::V3;
use p2m_core::storage::{Array, LoadError, Reader, Writer, require};

/// A grid of cells, each with a site.
#[derive(Clone, Debug)]
struct Grid {
    /// The low corner of the grid.
    low: V3,
    /// The number of cells in a unit of length.
    cells_per_length: f64,
    /// The numbers of cells along the axes.
    counts: [usize; 3],
    /// The site of each cell, x first. With [`REFINED_FLAG`] it is the number of a divided cell instead.
    cells: Array<u32>,
    /// The sites of the finer cells of each divided cell, x first.
    fine: Array<[u32; FINE_CELLS_PER_SIDE * FINE_CELLS_PER_SIDE * FINE_CELLS_PER_SIDE]>,
}

/// The locator of an index by default.
#[derive(Clone, Debug)]
pub(crate) struct GridLocator {
    /// The grid around the scene.
    near: Grid,
    /// The grid over the whole domain.
    far: Grid,
}

/// The flag of a cell that is divided into finer cells.
const REFINED_FLAG: u32 = 1 << 31;
/// The number of finer cells along an edge of a divided cell.
const FINE_CELLS_PER_SIDE: usize = 4;
/// The number of cells for each site in the grid around the scene.
const CELLS_PER_SITE: f64 = 2.0;
/// The number of cells along an edge of the grid over the domain, if there are enough sites.
const FAR_CELLS_PER_SIDE: f64 = 24.0;

impl Grid {
    /// Makes a grid of about `count` cubes over a box, without sites.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "few cells")]
    fn new(low: V3, high: V3, count: f64) -> Self {
        let extent: V3 = std::array::from_fn(|k| high[k] - low[k]);
        let side = (extent.iter().product::<f64>() / count).cbrt();
        let counts = extent.map(|x| ((x / side).ceil() as usize).max(1));
        let cells_per_length = side.recip();
        Self { low, cells_per_length, counts, cells: vec![0; counts.iter().product()].into(), fine: Array::default() }
    }

    /// Returns the number of the cell that contains a point, and the point in units of cells.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, and few cells")]
    fn cell_at(&self, point: &V3) -> Option<(usize, V3)> {
        let mut number = 0;
        let mut coordinates = [0.0; 3];
        for k in (0..3).rev() {
            let x = (point[k] - self.low[k]) * self.cells_per_length;
            // The comparison is false if a coordinate is NaN.
            if !(x >= 0.0 && x < self.counts[k] as f64) {
                return None;
            }
            coordinates[k] = x;
            number = number * self.counts[k] + x as usize;
        }
        Some((number, coordinates))
    }

    /// Returns the site of the cell that contains a point.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, and few cells")]
    fn site_at(&self, point: &V3) -> Option<usize> {
        let (number, coordinates) = self.cell_at(point)?;
        let cell = self.cells[number];
        if cell & REFINED_FLAG == 0 {
            return Some(cell as usize);
        }
        Some(self.fine[(cell & !REFINED_FLAG) as usize][fine_cell_at(&coordinates)] as usize)
    }

    /// Prefetches the cell that contains a point. The result is `false` if the point is outside of the grid.
    #[inline(always)]
    fn prefetch(&self, point: &V3) -> bool {
        let number = self.cell_at(point).map(|(number, _)| number);
        number.map(|number| prefetch(self.cells.as_ptr().wrapping_add(number).cast())).is_some()
    }

    /// Prefetches the finer cell that contains a point, if its cell is divided. The result is `false` if the point is
    /// outside of the grid.
    #[inline(always)]
    fn prefetch_fine(&self, point: &V3) -> bool {
        let Some((number, coordinates)) = self.cell_at(point) else { return false };
        let cell = self.cells[number];
        if cell & REFINED_FLAG != 0 {
            prefetch(
                self.fine[(cell & !REFINED_FLAG) as usize].as_ptr().wrapping_add(fine_cell_at(&coordinates)).cast(),
            );
        }
        true
    }

    fn memory(&self) -> usize {
        self.cells.memory() + self.fine.memory()
    }
}

/// Returns the index of the finer cell at a point, which is given in units of cells.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, and few cells")]
fn fine_cell_at(coordinates: &V3) -> usize {
    let [x, y, z] = coordinates.map(|x| (x * FINE_CELLS_PER_SIDE as f64) as usize & (FINE_CELLS_PER_SIDE - 1));
    (z * FINE_CELLS_PER_SIDE + y) * FINE_CELLS_PER_SIDE + x
}

impl Grid {
    /// Adds the grid to a file.
    fn save<'a>(&'a self, name: &str, writer: &mut Writer<'a>) {
        writer.put(&format!("{name}/cells"), &self.cells);
        writer.put(&format!("{name}/finer"), &self.fine);
        self.save_shape(name, writer);
    }

    /// Saves copies of the arrays, for a grid that does not outlive the writer.
    fn save_copy(&self, name: &str, writer: &mut Writer<'_>) {
        writer.put_copy(&format!("{name}/cells"), &self.cells);
        writer.put_copy(&format!("{name}/finer"), &self.fine);
        self.save_shape(name, writer);
    }

    /// Adds the fields that are not arrays.
    fn save_shape(&self, name: &str, writer: &mut Writer<'_>) {
        writer.put_copy(&format!("{name}/place"), &[[self.low[0], self.low[1], self.low[2], self.cells_per_length]]);
        writer.put_copy(&format!("{name}/counts"), &[self.counts.map(|n| n as u64)]);
    }

    /// Loads a grid over some sites from a file.
    fn load(name: &str, reader: &Reader, sites: usize) -> Result<Self, LoadError> {
        let [x, y, z, cells_per_length] = reader.one(&format!("{name}/place"))?;
        let counts = reader.one::<[u64; 3]>(&format!("{name}/counts"))?;
        let cells: Array<u32> = reader.array(&format!("{name}/cells"))?;
        require(!counts.contains(&0), name, "there are no cells")?;
        let product = counts.iter().try_fold(1u64, |product, n| product.checked_mul(*n));
        require(product == Some(cells.len() as u64), name, "there are not as many cells as the counts say")?;
        #[allow(clippy::cast_possible_truncation, reason = "there are as many cells in memory")]
        let counts = counts.map(|n| n as usize);
        let grid =
            Self { low: [x, y, z], cells_per_length, counts, cells, fine: reader.array(&format!("{name}/finer"))? };
        let is_cell = |cell: &u32| {
            let limit = if cell & REFINED_FLAG == 0 { sites } else { grid.fine.len() };
            ((cell & !REFINED_FLAG) as usize) < limit
        };
        require(grid.cells.iter().all(is_cell), name, "a cell has no site")?;
        let is_site = |site: &u32| (*site as usize) < sites;
        require(grid.fine.as_flattened().iter().all(is_site), name, "a finer cell has no site")?;
        Ok(grid)
    }
}

impl GridLocator {
    /// Adds the locator to a file.
    pub(crate) fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        self.near.save("hints/near", writer);
        self.far.save("hints/far", writer);
    }

    /// Saves copies of the arrays, for a locator that does not outlive the writer.
    pub(crate) fn save_copy(&self, writer: &mut Writer<'_>) {
        self.near.save_copy("hints/near", writer);
        self.far.save_copy("hints/far", writer);
    }

    /// Loads a locator over some sites from a file.
    pub(crate) fn load(reader: &Reader, sites: usize) -> Result<Self, LoadError> {
        Ok(Self { near: Grid::load("hints/near", reader, sites)?, far: Grid::load("hints/far", reader, sites)? })
    }
}

impl GridLocator {
    /// Builds both grids.
    pub(crate) fn new(sites: &LocatorSites<'_>) -> Self {
        let count = sites.positions().count() as f64;
        let [mut near, mut far] = [
            (sites.scene_box, CELLS_PER_SITE * count),
            (sites.domain_box, FAR_CELLS_PER_SIDE.powi(3).min(CELLS_PER_SITE * count)),
        ]
        .map(|([low, high], count)| Grid::new(low, high, count));
        let mut cells = std::mem::take(&mut near.cells);
        cells.edit(|cells| {
            let numbers = sites.positions().filter_map(|point| near.cell_at(&point));
            numbers.for_each(|(number, _)| cells[number] += 1);
        });
        near.cells = cells;
        [&mut near, &mut far]
            .into_iter()
            .for_each(|grid| sites.isa.run(FillGrid { grid, neighbours: sites.neighbours, first: sites.first() }));
        Self { near, far }
    }

    #[inline(always)]
    /// Returns the site of the cell that contains a point, or `None` outside of both grids.
    pub(crate) fn start(&self, point: &V3) -> Option<usize> {
        self.near.site_at(point).or_else(|| self.far.site_at(point))
    }

    /// Returns the heap memory in bytes.
    pub(crate) fn memory(&self) -> usize {
        self.near.memory() + self.far.memory()
    }

    #[inline(always)]
    /// Prefetches the memory that [`start`](Self::start) reads first.
    pub(crate) fn prefetch(&self, point: &V3) {
        let _ = self.near.prefetch(point) || self.far.prefetch(point);
    }

    #[inline(always)]
    /// Prefetches the memory that [`start`](Self::start) reads second.
    pub(crate) fn prefetch_more(&self, point: &V3) {
        let _ = self.near.prefetch_fine(point) || self.far.prefetch_fine(point);
    }
}

/// A SIMD kernel that finds the site nearest to the centre of each cell. Before it runs, a cell holds the number of
/// sites in it. Cells are visited back and forth along the axes, so that each walk begins at the site of an adjacent
/// cell and is short.
struct FillGrid<'a> {
    grid: &'a mut Grid,
    neighbours: &'a NeighbourTable,
    first: usize,
}

impl SimdKernel for FillGrid<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { grid, neighbours, first } = self;
        let [nx, ny, nz] = grid.counts;
        let mut cells = grid.cells.to_vec();
        let mut all_fine = Vec::new();
        let to_u32 = |n: usize| u32::try_from(n).expect("numbers of 32 bits");
        // A walk cannot leave a hub, so none begins at one.
        let is_hub = |site: &usize| neighbours.sites[*site].block_count == 0;
        let mut start = (first..neighbours.sites.len()).find(|site| !is_hub(site)).unwrap_or(first);
        for z in 0..nz {
            for j in 0..ny {
                let y = if z % 2 == 1 { ny - 1 - j } else { j };
                for i in 0..nx {
                    let x = if (z * ny + j) % 2 == 1 { nx - 1 - i } else { i };
                    let coordinates = [x as f64, y as f64, z as f64];
                    let cell = (z * ny + y) * nx + x;
                    let nearest = |from: usize, fraction: V3| {
                        let point = std::array::from_fn(|k| {
                            grid.low[k] + (coordinates[k] + fraction[k]) / grid.cells_per_length
                        });
                        neighbours.walk::<I>(from, &point, |_| ()).site
                    };
                    let has_several_sites = cells[cell] > 1;
                    let site = nearest(start, [0.5; 3]);
                    start = if is_hub(&site) { start } else { site };
                    cells[cell] = to_u32(site);
                    if has_several_sites {
                        let mut fine = [0; FINE_CELLS_PER_SIDE * FINE_CELLS_PER_SIDE * FINE_CELLS_PER_SIDE];
                        let mut fine_start = start;
                        for (n, to) in fine.iter_mut().enumerate() {
                            let fraction = [
                                n % FINE_CELLS_PER_SIDE,
                                n / FINE_CELLS_PER_SIDE % FINE_CELLS_PER_SIDE,
                                n / FINE_CELLS_PER_SIDE / FINE_CELLS_PER_SIDE,
                            ];
                            let site =
                                nearest(fine_start, fraction.map(|x| (x as f64 + 0.5) / FINE_CELLS_PER_SIDE as f64));
                            fine_start = if is_hub(&site) { fine_start } else { site };
                            *to = to_u32(site);
                        }
                        cells[cell] = to_u32(all_fine.len()) | REFINED_FLAG;
                        all_fine.push(fine);
                    }
                }
            }
        }
        all_fine.shrink_to_fit();
        (grid.cells, grid.fine) = (cells.into(), all_fine.into());
    }
}
