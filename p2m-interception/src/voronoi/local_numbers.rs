//! A map from keys, such as the tetrahedra around a packet, to consecutive numbers.

/// A hash map from keys to consecutive numbers, which count from 0 in the order of insertion. Clearing it does not
/// touch the table, except once in 2^32 times.
pub(crate) struct LocalNumbers {
    /// The hash table, with linear probing. An entry is valid if its round is the current one.
    places: Vec<Entry>,
    /// The number of the current round, above zero. Clearing the map begins the next round.
    round: u32,
    /// The keys in the order of their numbers.
    keys: Vec<u32>,
}

/// A key with its number.
#[derive(Clone, Copy, Default)]
struct Entry {
    round: u32,
    key: u32,
    number: u32,
}

impl Default for LocalNumbers {
    fn default() -> Self {
        Self { places: vec![Entry::default(); 1024], round: 1, keys: Vec::new() }
    }
}

impl LocalNumbers {
    /// Removes all keys.
    pub(crate) fn clear(&mut self) {
        self.keys.clear();
        self.round = self.round.checked_add(1).unwrap_or_else(|| {
            self.places.fill(Entry::default());
            1
        });
    }

    /// Returns the keys in the order of their numbers.
    #[inline(always)]
    pub(crate) fn keys(&self) -> &[u32] {
        &self.keys
    }

    /// Returns the number of a key, and whether it is new.
    #[inline(always)]
    pub(crate) fn number(&mut self, key: u32) -> (u32, bool) {
        if self.keys.len() * 2 >= self.places.len() {
            self.grow();
        }
        // There are fewer numbers than keys.
        #[allow(clippy::cast_possible_truncation, reason = "numbers of 32 bits")]
        let number = self.place(key, self.keys.len() as u32);
        let is_new = number as usize == self.keys.len();
        if is_new {
            self.keys.push(key);
        }
        (number, is_new)
    }

    /// Inserts a key with a number by linear probing, unless the key has a number already. Returns the number of the
    /// key.
    #[inline(always)]
    fn place(&mut self, key: u32, number: u32) -> u32 {
        let mask = self.places.len() - 1;
        // The upper half of the product depends on all bits of the key.
        let mut at = (u64::from(key).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize;
        loop {
            let entry = &mut self.places[at & mask];
            if entry.round != self.round {
                *entry = Entry { round: self.round, key, number };
                return number;
            }
            if entry.key == key {
                return entry.number;
            }
            at += 1;
        }
    }

    /// Doubles the number of places.
    #[cold]
    fn grow(&mut self) {
        self.places = vec![Entry::default(); self.places.len() * 2];
        for (number, key) in (0..).zip(std::mem::take(&mut self.keys)) {
            self.place(key, number);
            self.keys.push(key);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_testkit::rng;
    use rand::RngExt;

    #[test]
    fn keys_have_the_numbers_in_which_they_came_since_the_last_ones_were_removed() {
        let mut numbers = LocalNumbers { round: u32::MAX - 20, ..LocalNumbers::default() };
        let mut rng = rng("local numbers", 0);
        for round in 0..40 {
            let mut expected: Vec<u32> = Vec::new();
            for _ in 0..1 << (round % 12) {
                let key = rng.random_range(0..1500) << (round % 3 * 9);
                let at = expected.iter().position(|k| *k == key);
                let (number, is_new) = numbers.number(key);
                assert_eq!((number as usize, is_new), (at.unwrap_or(expected.len()), at.is_none()), "{round} {key}");
                if is_new {
                    expected.push(key);
                }
            }
            assert_eq!(numbers.keys(), expected);
            numbers.clear();
        }
    }
}
