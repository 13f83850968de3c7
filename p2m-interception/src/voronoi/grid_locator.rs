//! Where a walk begins: for each cell_at of a grid the site_at that is nearest to its middle. One grid lies around the scene;
//! its cells with several sites are cut into 64. A coarser one lies over the whole domain_box.

use crate::voronoi::locator::LocatorSites;
use crate::voronoi::neighbours::NeighbourTable;
use p2m_core::engine::simd::{InstructionSet, SimdKernel, prefetch};
use p2m_core::engine::vector::V3;
use p2m_core::storage::{Array, LoadError, Reader, Writer};

/// Sites by a grid of cells.
#[derive(Clone, Debug)]
struct Grid {
    low: V3,
    /// CellContext in a unit of length.
    cells_per_length: f64,
    counts: [usize; 3],
    /// A site_at; or, with [`REFINED_FLAG`], the number of a finer grid.
    cells: Array<u32>,
    fine: Array<[u32; FINE_CELLS_PER_SIDE * FINE_CELLS_PER_SIDE * FINE_CELLS_PER_SIDE]>,
}

/// The default locator of an index: a fine grid around the scene and a coarse one over the whole domain_box.
#[derive(Clone, Debug)]
pub(crate) struct GridLocator {
    near: Grid,
    far: Grid,
}

const REFINED_FLAG: u32 = 1 << 31;
/// CellContext along a side of a cell_at that is cut.
const FINE_CELLS_PER_SIDE: usize = 4;
/// CellContext of the grid around the scene for each site_at, and of the other one along a side.
const CELLS_PER_SITE: f64 = 2.0;
const FAR_CELLS_PER_SIDE: f64 = 24.0;

impl Grid {
    /// Over a box, of about `count` cubes.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "few cells")]
    fn new(low: V3, high: V3, count: f64) -> Self {
        let extent: V3 = std::array::from_fn(|k| high[k] - low[k]);
        let side = (extent.iter().product::<f64>() / count).cbrt();
        let counts = extent.map(|x| ((x / side).ceil() as usize).max(1));
        let cells_per_length = side.recip();
        Self { low, cells_per_length, counts, cells: vec![0; counts.iter().product()].into(), fine: Array::default() }
    }

    /// The number of the cell_at of a point, and the point in cells.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, and few cells")]
    fn cell_at(&self, point: &V3) -> Option<(usize, V3)> {
        let mut number = 0;
        let mut at = [0.0; 3];
        for k in (0..3).rev() {
            let x = (point[k] - self.low[k]) * self.cells_per_length;
            // Not for NaN either.
            if !(x >= 0.0 && x < self.counts[k] as f64) {
                return None;
            }
            at[k] = x;
            number = number * self.counts[k] + x as usize;
        }
        Some((number, at))
    }

    /// The site_at for a point in the grid.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, and few cells")]
    fn site_at(&self, point: &V3) -> Option<usize> {
        let (number, at) = self.cell_at(point)?;
        let cell_at = self.cells[number];
        if cell_at & REFINED_FLAG == 0 {
            return Some(cell_at as usize);
        }
        Some(self.fine[(cell_at & !REFINED_FLAG) as usize][fine_cell_at(&at)] as usize)
    }

    /// Asks for the cell_at of a point, if the grid has it.
    #[inline(always)]
    fn prefetch(&self, point: &V3) -> bool {
        let number = self.cell_at(point).map(|(number, _)| number);
        number.map(|number| prefetch(self.cells.as_ptr().wrapping_add(number).cast())).is_some()
    }

    /// Asks for its finer cell_at, if there is one; `false` if the grid does not have the point.
    #[inline(always)]
    fn prefetch_fine(&self, point: &V3) -> bool {
        let Some((number, at)) = self.cell_at(point) else { return false };
        let cell_at = self.cells[number];
        if cell_at & REFINED_FLAG != 0 {
            prefetch(self.fine[(cell_at & !REFINED_FLAG) as usize].as_ptr().wrapping_add(fine_cell_at(&at)).cast());
        }
        true
    }

    fn memory(&self) -> usize {
        self.cells.memory() + self.fine.memory()
    }
}

/// The number of the finer cell_at of a point that is given in cells.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, and few cells")]
fn fine_cell_at(at: &V3) -> usize {
    let [x, y, z] = at.map(|x| (x * FINE_CELLS_PER_SIDE as f64) as usize & (FINE_CELLS_PER_SIDE - 1));
    (z * FINE_CELLS_PER_SIDE + y) * FINE_CELLS_PER_SIDE + x
}

impl Grid {
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

    fn save_shape(&self, name: &str, writer: &mut Writer<'_>) {
        writer.put_copy(&format!("{name}/place"), &[[self.low[0], self.low[1], self.low[2], self.cells_per_length]]);
        writer.put_copy(&format!("{name}/counts"), &[self.counts.map(|n| n as u64)]);
    }

    fn load(name: &str, reader: &Reader) -> Result<Self, LoadError> {
        let [x, y, z, cells_per_length] = reader.one(&format!("{name}/place"))?;
        let counts = reader.one::<[u64; 3]>(&format!("{name}/counts"))?;
        let cells: Array<u32> = reader.array(&format!("{name}/cells"))?;
        let fits = counts.iter().try_fold(1u64, |product, n| product.checked_mul(*n)) == Some(cells.len() as u64);
        if !fits {
            return Err(LoadError::Inconsistent { section: name.to_owned() });
        }
        #[allow(clippy::cast_possible_truncation, reason = "there are as many cells in memory")]
        let counts = counts.map(|n| n as usize);
        Ok(Self { low: [x, y, z], cells_per_length, counts, cells, fine: reader.array(&format!("{name}/finer"))? })
    }
}

impl GridLocator {
    pub(crate) fn save<'a>(&'a self, writer: &mut Writer<'a>) {
        self.near.save("hints/near", writer);
        self.far.save("hints/far", writer);
    }

    /// Saves copies of the arrays, for a locator that does not outlive the writer.
    pub(crate) fn save_copy(&self, writer: &mut Writer<'_>) {
        self.near.save_copy("hints/near", writer);
        self.far.save_copy("hints/far", writer);
    }

    pub(crate) fn load(reader: &Reader) -> Result<Self, LoadError> {
        Ok(Self { near: Grid::load("hints/near", reader)?, far: Grid::load("hints/far", reader)? })
    }
}

impl GridLocator {
    /// Makes both grids for some sites.
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
    pub(crate) fn start(&self, point: &V3) -> Option<usize> {
        self.near.site_at(point).or_else(|| self.far.site_at(point))
    }

    pub(crate) fn memory(&self) -> usize {
        self.near.memory() + self.far.memory()
    }

    #[inline(always)]
    pub(crate) fn prefetch(&self, point: &V3) {
        let _ = self.near.prefetch(point) || self.far.prefetch(point);
    }

    #[inline(always)]
    pub(crate) fn prefetch_more(&self, point: &V3) {
        let _ = self.near.prefetch_fine(point) || self.far.prefetch_fine(point);
    }
}

/// Fills a grid, whose cells hold how many sites are in them, there and back along each axis, so that every walk is
/// short.
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
        let number = |n: usize| u32::try_from(n).expect("numbers of 32 bits");
        let mut site_at = first;
        for z in 0..nz {
            for j in 0..ny {
                let y = if z % 2 == 1 { ny - 1 - j } else { j };
                for i in 0..nx {
                    let x = if (z * ny + j) % 2 == 1 { nx - 1 - i } else { i };
                    let at = [x as f64, y as f64, z as f64];
                    let cell_at = (z * ny + y) * nx + x;
                    let nearest = |from: usize, off: V3| {
                        let point = std::array::from_fn(|k| grid.low[k] + (at[k] + off[k]) / grid.cells_per_length);
                        neighbours.walk::<I>(from, &point, |_| ()).site
                    };
                    let several = cells[cell_at] > 1;
                    site_at = nearest(site_at, [0.5; 3]);
                    cells[cell_at] = number(site_at);
                    if several {
                        let mut fine = [0; FINE_CELLS_PER_SIDE * FINE_CELLS_PER_SIDE * FINE_CELLS_PER_SIDE];
                        let mut scene_box = site_at;
                        for (n, to) in fine.iter_mut().enumerate() {
                            let off = [
                                n % FINE_CELLS_PER_SIDE,
                                n / FINE_CELLS_PER_SIDE % FINE_CELLS_PER_SIDE,
                                n / FINE_CELLS_PER_SIDE / FINE_CELLS_PER_SIDE,
                            ];
                            scene_box = nearest(scene_box, off.map(|x| (x as f64 + 0.5) / FINE_CELLS_PER_SIDE as f64));
                            *to = number(scene_box);
                        }
                        cells[cell_at] = number(all_fine.len()) | REFINED_FLAG;
                        all_fine.push(fine);
                    }
                }
            }
        }
        all_fine.shrink_to_fit();
        (grid.cells, grid.fine) = (cells.into(), all_fine.into());
    }
}
