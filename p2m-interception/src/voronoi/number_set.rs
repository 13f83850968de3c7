//! A set of numbers that is emptied without touching its memory.

/// A set of numbers of 32 bits.
pub(crate) struct NumberSet {
    /// Numbers in the lower halves, each at its place or after it. In the upper half is the round in which the number
    /// was inserted.
    places: Vec<u64>,
    /// The round, above zero. It ends when the set is emptied.
    round: u32,
    /// The number of numbers.
    len: usize,
}

impl Default for NumberSet {
    fn default() -> Self {
        Self { places: vec![0; 1024], round: 1, len: 0 }
    }
}

impl NumberSet {
    /// Removes all numbers.
    pub(crate) fn clear(&mut self) {
        self.len = 0;
        self.round = self.round.checked_add(1).unwrap_or_else(|| {
            self.places.fill(0);
            1
        });
    }

    /// Inserts a number, and returns whether it is new.
    #[inline(always)]
    pub(crate) fn insert(&mut self, number: u32) -> bool {
        if self.len * 2 >= self.places.len() {
            self.grow();
        }
        let is_new = self.place(number);
        self.len += usize::from(is_new);
        is_new
    }

    /// Puts a number into the first free place from its own on, unless it is there.
    #[inline(always)]
    fn place(&mut self, number: u32) -> bool {
        let entry = u64::from(self.round) << 32 | u64::from(number);
        let mask = self.places.len() - 1;
        // The upper bits of the product depend on all bits of the number.
        let mut at = (u64::from(number).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as usize & mask;
        loop {
            let place = &mut self.places[at & mask];
            if *place == entry {
                return false;
            }
            if *place >> 32 != u64::from(self.round) {
                *place = entry;
                return true;
            }
            at += 1;
        }
    }

    /// Doubles the number of places.
    #[cold]
    fn grow(&mut self) {
        let places = vec![0; self.places.len() * 2];
        for entry in std::mem::replace(&mut self.places, places) {
            if entry >> 32 == u64::from(self.round) {
                self.place(entry as u32);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_testkit::rng;
    use rand::RngExt;
    use std::collections::HashSet;

    #[test]
    fn it_has_what_was_inserted_since_it_was_emptied() {
        let mut set = NumberSet { round: u32::MAX - 20, ..NumberSet::default() };
        let mut rng = rng("number set", 0);
        for round in 0..40 {
            let mut expected = HashSet::new();
            for _ in 0..1 << (round % 14) {
                let number = rng.random_range(0..5000) << (round % 3 * 9);
                assert_eq!(set.insert(number), expected.insert(number), "{round} {number}");
            }
            set.clear();
        }
    }
}
