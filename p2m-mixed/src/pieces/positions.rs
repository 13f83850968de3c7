//! The positions of the vertices of a file, in memory up to a limit and beyond it in a temporary file.

use nalgebra::Point3;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::PathBuf;

/// The number of positions in a block, which is written and read as a whole.
pub(super) const BLOCK_POSITIONS: usize = 1 << 12;
/// The number of bytes of a position.
const POSITION_BYTES: usize = 24;
/// The number of bytes of a block.
pub(super) const BLOCK_BYTES: usize = BLOCK_POSITIONS * POSITION_BYTES;
/// The slot of a block that is not in memory.
const NO_SLOT: u32 = u32::MAX;
/// The smallest number of blocks in memory. The last block stays there while it grows.
const MIN_SLOTS: usize = 2;

/// A block of positions in memory.
struct Slot {
    positions: Vec<Point3<f64>>,
    block: usize,
    /// Whether the block differs from its copy in the file.
    is_dirty: bool,
    /// Whether the block was used since the clock hand passed it last.
    is_used: bool,
}

/// A list of positions, of which memory holds a limited number of blocks.
///
/// If another block is needed, the store writes a block that was not used lately to the temporary file, unless it is
/// there already, and reuses its slot. The choice is that of the clock algorithm: a hand goes round the slots, clears
/// the mark of each block that was used, and stops at the first one without a mark.
pub(super) struct PositionStore {
    len: usize,
    /// The slot of each block, or [`NO_SLOT`].
    slot_of_block: Vec<u32>,
    slots: Vec<Slot>,
    max_slots: usize,
    /// The clock hand: the slot that is examined first when a slot is needed.
    hand: usize,
    /// The file of the blocks, which is created when the first block leaves the memory.
    file: Option<File>,
    /// The folder of the file, or `None` for that of the system.
    folder: Option<PathBuf>,
    /// The bytes of a block while it is written or read.
    buffer: Vec<u8>,
}

impl PositionStore {
    /// Makes a store with at most `max_bytes` of positions in memory, or two blocks if that is more.
    pub(super) fn new(max_bytes: usize, folder: Option<PathBuf>) -> Self {
        let max_slots = (max_bytes / BLOCK_BYTES).clamp(MIN_SLOTS, NO_SLOT as usize);
        let (slot_of_block, slots, buffer) = Default::default();
        Self { len: 0, slot_of_block, slots, max_slots, hand: 0, file: None, folder, buffer }
    }

    /// Returns the number of positions.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Adds a position.
    pub(super) fn push(&mut self, position: Point3<f64>) -> io::Result<()> {
        let block = self.len / BLOCK_POSITIONS;
        if block == self.slot_of_block.len() {
            let slot = self.free_slot()?;
            self.slot_of_block.push(NO_SLOT);
            self.occupy(slot, block);
        }
        let slot = self.slot(block)?;
        slot.is_dirty = true;
        slot.positions.push(position);
        self.len += 1;
        Ok(())
    }

    /// Returns the position with a number, which has to be in range.
    pub(super) fn get(&mut self, number: usize) -> io::Result<Point3<f64>> {
        Ok(self.slot(number / BLOCK_POSITIONS)?.positions[number % BLOCK_POSITIONS])
    }

    /// Returns a block, and reads it first if it is not in memory.
    #[inline]
    fn slot(&mut self, block: usize) -> io::Result<&mut Slot> {
        let mut slot = self.slot_of_block[block] as usize;
        if slot == NO_SLOT as usize {
            slot = self.read(block)?;
        }
        let slot = &mut self.slots[slot];
        slot.is_used = true;
        Ok(slot)
    }

    /// Reads a block into a slot, and returns the slot.
    #[cold]
    fn read(&mut self, block: usize) -> io::Result<usize> {
        let slot = self.free_slot()?;
        self.buffer.resize(POSITION_BYTES * BLOCK_POSITIONS.min(self.len - block * BLOCK_POSITIONS), 0);
        if let Some(file) = &mut self.file {
            file.seek(offset(block))?;
            file.read_exact(&mut self.buffer)?;
        }
        let numbers = |bytes: &[[u8; 8]]| Point3::from(std::array::from_fn(|k| f64::from_le_bytes(bytes[k])));
        let positions = self.buffer.as_chunks().0.chunks_exact(3).map(numbers);
        self.slots[slot].positions.extend(positions);
        self.occupy(slot, block);
        Ok(slot)
    }

    #[allow(clippy::cast_possible_truncation, reason = "there are fewer slots than u32 can count")]
    fn occupy(&mut self, slot: usize, block: usize) {
        self.slot_of_block[block] = slot as u32;
        self.slots[slot].block = block;
    }

    /// Returns a slot without a block.
    fn free_slot(&mut self) -> io::Result<usize> {
        if self.slots.len() < self.max_slots {
            let positions = Vec::with_capacity(BLOCK_POSITIONS);
            self.slots.push(Slot { positions, block: 0, is_dirty: false, is_used: false });
            return Ok(self.slots.len() - 1);
        }
        // The search ends in the second round at the latest, because the first one clears all marks.
        while std::mem::take(&mut self.slots[self.hand].is_used) {
            self.hand = (self.hand + 1) % self.slots.len();
        }
        let number = self.hand;
        self.hand = (number + 1) % self.slots.len();
        let slot = &mut self.slots[number];
        if slot.is_dirty {
            self.buffer.clear();
            self.buffer.extend(slot.positions.iter().flat_map(|p| p.iter()).flat_map(|x| x.to_le_bytes()));
            let file = match &mut self.file {
                Some(file) => file,
                none => none.insert(match &self.folder {
                    Some(folder) => tempfile::tempfile_in(folder)?,
                    None => tempfile::tempfile()?,
                }),
            };
            file.seek(offset(slot.block))?;
            file.write_all(&self.buffer)?;
            slot.is_dirty = false;
        }
        self.slot_of_block[slot.block] = NO_SLOT;
        slot.positions.clear();
        Ok(number)
    }
}

/// Returns the offset of a block in the file.
fn offset(block: usize) -> SeekFrom {
    SeekFrom::Start(block as u64 * BLOCK_BYTES as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::VecDeque;

    #[test]
    fn blocks_leave_the_memory_and_return_with_the_same_bits() {
        let bits = |number: usize| {
            let number = number as u64;
            [number.wrapping_mul(0x9e37_79b9_7f4a_7c15), f64::NAN.to_bits() ^ number, (-0.0f64).to_bits()]
        };
        let mut store = PositionStore::new(3 * BLOCK_BYTES, None);
        let mut recent = VecDeque::new();
        for number in 0..6 * BLOCK_POSITIONS + 17 {
            store.push(Point3::from(bits(number).map(f64::from_bits))).unwrap();
            assert_eq!(store.len(), number + 1);
            assert!(store.slots.len() <= 3);
            assert_eq!(store.file.is_some(), number >= 3 * BLOCK_POSITIONS, "{number}");
            // Steps without a common divisor with the length of a block reach blocks in memory and in the file, also
            // while the last block grows.
            recent.push_back(number * 7919 % (number + 1));
            if number % 1009 == 0 {
                for at in recent.drain(..).chain([0, number]) {
                    assert_eq!(store.get(at).unwrap().coords.map(f64::to_bits).data.0[0], bits(at));
                }
                assert!(store.slots.len() <= 3);
            }
        }
        let resident = store.slots.iter().map(|slot| slot.positions.capacity()).sum::<usize>();
        assert_eq!(resident, 3 * BLOCK_POSITIONS);
        let folder = Some(PathBuf::from("/no such folder"));
        let mut store = PositionStore::new(0, folder);
        let error = (0..3 * BLOCK_POSITIONS).find_map(|_| store.push(Point3::origin()).err());
        assert_eq!(error.map(|error| error.kind()), Some(io::ErrorKind::NotFound));
    }
}
