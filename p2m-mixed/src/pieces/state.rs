//! The state of a scene that is built in pieces: the vertices of the file, and the vertices that the current piece
//! uses.

use super::positions::PositionStore;
use crate::error::Reason;
use crate::open::open;
use crate::scene::Scene;
use hashbrown::HashTable;
use hashbrown::hash_table::Entry;
use nalgebra::Point3;
use p2m_core::Soup;
use std::fs::File;
use std::hash::{BuildHasher, RandomState};
use std::io::{self, BufReader};
use std::ops::ControlFlow;
use std::path::Path;

/// A function that takes a full piece and returns whether reading goes on.
type Visitor<'a> = dyn FnMut(Scene) -> ControlFlow<()> + 'a;

/// The positions of vertices that primitives may use.
enum Positions {
    /// The vertices of the file.
    OfFile(PositionStore),
    /// The vertices since the last call of [`Pieces::forget_old_vertices`].
    OfPiece(Vec<Point3<f64>>),
}

/// The state of a scene that is built in pieces.
pub(crate) struct Pieces<'a> {
    max_primitives: usize,
    path: &'a Path,
    positions: Positions,
    indices: IndexTable,
    visitor: &'a mut Visitor<'a>,
    /// Whether a piece has ended since the last call of [`Pieces::forget_old_vertices`].
    has_ended: bool,
}

impl<'a> Pieces<'a> {
    pub(super) fn new(
        max_primitives: usize,
        path: &'a Path,
        store: PositionStore,
        visitor: &'a mut Visitor<'a>,
    ) -> Self {
        let (positions, indices) = (Positions::OfFile(store), IndexTable::default());
        Self { max_primitives, path, positions, indices, visitor, has_ended: false }
    }

    /// Keeps only the vertices of the current piece, in memory.
    pub(crate) fn keep_vertices_of_pieces(&mut self) {
        self.positions = Positions::OfPiece(Vec::new());
    }

    /// Opens the file another time, unless it is a pipe or cannot be opened.
    pub(crate) fn open_again(&self) -> Option<BufReader<File>> {
        let is_file = self.path.metadata().is_ok_and(|m| m.is_file());
        is_file.then(|| open(self.path, "").ok()).flatten()
    }

    /// Returns the number of primitives of a full piece.
    pub(crate) fn max_primitives(&self) -> usize {
        self.max_primitives
    }

    /// Returns the number of vertices that primitives may use.
    pub(crate) fn vertex_count(&self) -> usize {
        match &self.positions {
            Positions::OfFile(store) => store.len(),
            Positions::OfPiece(positions) => positions.len(),
        }
    }

    /// Returns the positions of the current piece if only they are kept, and otherwise an empty list, because positions
    /// of the whole file may be in the temporary file.
    pub(crate) fn resident_positions(&self) -> &[Point3<f64>] {
        match &self.positions {
            Positions::OfFile(_) => &[],
            Positions::OfPiece(positions) => positions,
        }
    }

    pub(crate) fn push_position(&mut self, position: Point3<f64>) -> Result<(), Reason> {
        match &mut self.positions {
            Positions::OfFile(store) => store.push(position).map_err(temporary_file_error),
            Positions::OfPiece(positions) => {
                positions.push(position);
                Ok(())
            }
        }
    }

    /// Returns the position of a vertex, which has to be in range.
    pub(crate) fn position(&mut self, vertex: u32) -> Result<Point3<f64>, Reason> {
        match &mut self.positions {
            Positions::OfFile(store) => store.get(vertex as usize).map_err(temporary_file_error),
            Positions::OfPiece(positions) => Ok(positions[vertex as usize]),
        }
    }

    /// Returns the index of a vertex in the soup of the current piece, to which it is added if it is not there.
    pub(crate) fn index(&mut self, vertex: u32, soup: &mut Soup<f64>) -> Result<u32, Reason> {
        let next = u32::try_from(soup.positions().len()).expect("at most three vertices for each of 2^30 primitives");
        let index = self.indices.get_or_insert(vertex, next);
        if index == next {
            soup.try_push_position(self.position(vertex)?).map_err(Reason::Build)?;
        }
        Ok(index)
    }

    /// Passes a full piece to the visitor.
    pub(crate) fn visit(&mut self, piece: Scene) -> Result<(), Reason> {
        self.indices.clear();
        self.has_ended = true;
        match (self.visitor)(piece) {
            ControlFlow::Continue(()) => Ok(()),
            // The caller returns the error of the visitor instead.
            ControlFlow::Break(()) => Err(Reason::Io(io::ErrorKind::Interrupted.into())),
        }
    }

    /// Removes all vertices and returns `true` if a piece has ended since the last call.
    pub(crate) fn forget_old_vertices(&mut self) -> bool {
        let has_ended = std::mem::take(&mut self.has_ended);
        if let Positions::OfPiece(positions) = &mut self.positions
            && has_ended
        {
            positions.clear();
            self.indices.clear();
        }
        has_ended
    }
}

fn temporary_file_error(error: io::Error) -> Reason {
    Reason::Io(io::Error::new(error.kind(), format!("the temporary file of vertices: {error}")))
}

/// The map from vertices of the file to indices in the current piece.
struct IndexTable {
    /// Vertices and their indices.
    table: HashTable<(u32, u32)>,
    /// A random seed, so that no file can be crafted whose vertices have equal hashes.
    seed: u64,
}

impl Default for IndexTable {
    fn default() -> Self {
        Self { table: HashTable::new(), seed: RandomState::new().hash_one(0) }
    }
}

impl IndexTable {
    fn clear(&mut self) {
        self.table.clear();
    }

    /// Returns the index of a vertex. A vertex without an index gets `next`.
    fn get_or_insert(&mut self, vertex: u32, next: u32) -> u32 {
        let seed = self.seed;
        let hash = |vertex: u32| hash(vertex, seed);
        match self.table.entry(hash(vertex), |&(other, _)| other == vertex, |&(other, _)| hash(other)) {
            Entry::Occupied(entry) => entry.get().1,
            Entry::Vacant(entry) => entry.insert((vertex, next)).get().1,
        }
    }
}

/// Hashes a vertex by folded multiplication: the exclusive or of both halves of a product of 128 bits.
#[allow(clippy::cast_possible_truncation, reason = "the halves of the product are meant")]
fn hash(vertex: u32, seed: u64) -> u64 {
    let product = u128::from(u64::from(vertex) ^ seed) * 0x9e37_79b9_7f4a_7c15;
    product as u64 ^ (product >> 64) as u64
}
