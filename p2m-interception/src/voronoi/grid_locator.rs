//! Where a walk begins: for each cell of a grid the site that is nearest to its middle. One grid lies around the scene;
//! its cells with several sites are cut into 64. A coarser one lies over the whole domain.

use crate::voronoi::locator::LocatorSites;
use crate::voronoi::neighbours::Fans;
use p2m_core::engine::simd::{InstructionSet, SimdKernel, prefetch};
use p2m_core::engine::vector::V3;
use p2m_core::storage::{Array, LoadError, Reader, Writer};

/// Sites by a grid of cells.
#[derive(Clone, Debug)]
struct Grid {
    low: V3,
    /// Cells in a unit of length.
    per_length: f64,
    counts: [usize; 3],
    /// A site; or, with [`CUT`], the number of a finer grid.
    cells: Array<u32>,
    fine: Array<[u32; FINE * FINE * FINE]>,
}

/// The default locator of an index: a fine grid around the scene and a coarse one over the whole domain.
#[derive(Clone, Debug)]
pub(crate) struct Hints {
    near: Grid,
    far: Grid,
}

const CUT: u32 = 1 << 31;
/// Cells along a side of a cell that is cut.
const FINE: usize = 4;
/// Cells of the grid around the scene for each site, and of the other one along a side.
const CELLS: f64 = 2.0;
const SIDE: f64 = 24.0;

impl Grid {
    /// Over a box, of about `count` cubes.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "few cells")]
    fn new(low: V3, high: V3, count: f64) -> Self {
        let extent: V3 = std::array::from_fn(|k| high[k] - low[k]);
        let side = (extent.iter().product::<f64>() / count).cbrt();
        let counts = extent.map(|x| ((x / side).ceil() as usize).max(1));
        let per_length = side.recip();
        Self { low, per_length, counts, cells: vec![0; counts.iter().product()].into(), fine: Array::default() }
    }

    /// The number of the cell of a place, and the place in cells.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, and few cells")]
    fn cell(&self, place: &V3) -> Option<(usize, V3)> {
        let mut number = 0;
        let mut at = [0.0; 3];
        for k in (0..3).rev() {
            let x = (place[k] - self.low[k]) * self.per_length;
            // Not for NaN either.
            if !(x >= 0.0 && x < self.counts[k] as f64) {
                return None;
            }
            at[k] = x;
            number = number * self.counts[k] + x as usize;
        }
        Some((number, at))
    }

    /// The site for a place in the grid.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, and few cells")]
    fn site(&self, place: &V3) -> Option<usize> {
        let (number, at) = self.cell(place)?;
        let cell = self.cells[number];
        if cell & CUT == 0 {
            return Some(cell as usize);
        }
        Some(self.fine[(cell & !CUT) as usize][within(&at)] as usize)
    }

    /// Asks for the cell of a place, if the grid has it.
    #[inline(always)]
    fn prefetch(&self, place: &V3) -> bool {
        let number = self.cell(place).map(|(number, _)| number);
        number.map(|number| prefetch(self.cells.as_ptr().wrapping_add(number).cast())).is_some()
    }

    /// Asks for its finer cell, if there is one; `false` if the grid does not have the place.
    #[inline(always)]
    fn prefetch_fine(&self, place: &V3) -> bool {
        let Some((number, at)) = self.cell(place) else { return false };
        let cell = self.cells[number];
        if cell & CUT != 0 {
            prefetch(self.fine[(cell & !CUT) as usize].as_ptr().wrapping_add(within(&at)).cast());
        }
        true
    }

    fn memory(&self) -> usize {
        self.cells.memory() + self.fine.memory()
    }
}

/// The number of the finer cell of a place that is given in cells.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, and few cells")]
fn within(at: &V3) -> usize {
    let [x, y, z] = at.map(|x| (x * FINE as f64) as usize & (FINE - 1));
    (z * FINE + y) * FINE + x
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
        writer.put_copy(&format!("{name}/place"), &[[self.low[0], self.low[1], self.low[2], self.per_length]]);
        writer.put_copy(&format!("{name}/counts"), &[self.counts.map(|n| n as u64)]);
    }

    fn load(name: &str, reader: &Reader) -> Result<Self, LoadError> {
        let [x, y, z, per_length] = reader.one(&format!("{name}/place"))?;
        let counts = reader.one::<[u64; 3]>(&format!("{name}/counts"))?;
        let cells: Array<u32> = reader.array(&format!("{name}/cells"))?;
        let fits = counts.iter().try_fold(1u64, |product, n| product.checked_mul(*n)) == Some(cells.len() as u64);
        if !fits {
            return Err(LoadError::Inconsistent { section: name.to_owned() });
        }
        #[allow(clippy::cast_possible_truncation, reason = "there are as many cells in memory")]
        let counts = counts.map(|n| n as usize);
        Ok(Self { low: [x, y, z], per_length, counts, cells, fine: reader.array(&format!("{name}/finer"))? })
    }
}

impl Hints {
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

impl Hints {
    /// Makes both grids for some sites.
    pub(crate) fn new(sites: &LocatorSites<'_>) -> Self {
        let count = sites.places().count() as f64;
        let [mut near, mut far] = [(sites.own, CELLS * count), (sites.domain, SIDE.powi(3).min(CELLS * count))]
            .map(|([low, high], count)| Grid::new(low, high, count));
        let mut cells = std::mem::take(&mut near.cells);
        cells.edit(|cells| {
            let numbers = sites.places().filter_map(|place| near.cell(&place));
            numbers.for_each(|(number, _)| cells[number] += 1);
        });
        near.cells = cells;
        [&mut near, &mut far]
            .into_iter()
            .for_each(|grid| sites.isa.run(Fill { grid, fans: sites.fans, first: sites.first() }));
        Self { near, far }
    }

    #[inline(always)]
    pub(crate) fn start(&self, place: &V3) -> Option<usize> {
        self.near.site(place).or_else(|| self.far.site(place))
    }

    pub(crate) fn memory(&self) -> usize {
        self.near.memory() + self.far.memory()
    }

    #[inline(always)]
    pub(crate) fn prefetch(&self, place: &V3) {
        let _ = self.near.prefetch(place) || self.far.prefetch(place);
    }

    #[inline(always)]
    pub(crate) fn prefetch_more(&self, place: &V3) {
        let _ = self.near.prefetch_fine(place) || self.far.prefetch_fine(place);
    }
}

/// Fills a grid, whose cells hold how many sites are in them, there and back along each axis, so that every walk is
/// short.
struct Fill<'a> {
    grid: &'a mut Grid,
    fans: &'a Fans,
    first: usize,
}

impl SimdKernel for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: InstructionSet>(self) {
        let Self { grid, fans, first } = self;
        let [nx, ny, nz] = grid.counts;
        let mut cells = grid.cells.to_vec();
        let mut all_fine = Vec::new();
        let number = |n: usize| u32::try_from(n).expect("numbers of 32 bits");
        let mut site = first;
        for z in 0..nz {
            for j in 0..ny {
                let y = if z % 2 == 1 { ny - 1 - j } else { j };
                for i in 0..nx {
                    let x = if (z * ny + j) % 2 == 1 { nx - 1 - i } else { i };
                    let at = [x as f64, y as f64, z as f64];
                    let cell = (z * ny + y) * nx + x;
                    let nearest = |from: usize, off: V3| {
                        let place = std::array::from_fn(|k| grid.low[k] + (at[k] + off[k]) / grid.per_length);
                        fans.walk::<I>(from, &place, |_| ()).site
                    };
                    let several = cells[cell] > 1;
                    site = nearest(site, [0.5; 3]);
                    cells[cell] = number(site);
                    if several {
                        let mut fine = [0; FINE * FINE * FINE];
                        let mut own = site;
                        for (n, to) in fine.iter_mut().enumerate() {
                            let off = [n % FINE, n / FINE % FINE, n / FINE / FINE];
                            own = nearest(own, off.map(|x| (x as f64 + 0.5) / FINE as f64));
                            *to = number(own);
                        }
                        cells[cell] = number(all_fine.len()) | CUT;
                        all_fine.push(fine);
                    }
                }
            }
        }
        all_fine.shrink_to_fit();
        (grid.cells, grid.fine) = (cells.into(), all_fine.into());
    }
}
