//! The rounds in which sites are inserted into a Delaunay triangulation.
//!
//! Sites are sorted along a Hilbert curve first ([`p2m_core::engine::curve`]). Points next to each other on the curve
//! are near each other in space, so the walk from the last inserted site to the next one is short. A biased randomised
//! insertion order \[Amenta2003\] also keeps the expected number of tetrahedra that are created and destroyed low.
//! Each site is deferred to the last round with probability 7/8, otherwise to the round before it with the same
//! probability, and so on. Each round keeps the order along the curve.

/// Returns the round of a site, counted from the last one.
fn round(site: usize) -> u32 {
    // The next lines mix all bits into the lowest ones \[Steele2014\].
    let mut x = (site as u64).wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    (x ^ x >> 31).trailing_zeros() / 3
}

/// Returns the sites in order of insertion, one round after the other.
pub(crate) fn rounds(sites: std::ops::Range<usize>) -> impl Iterator<Item = usize> {
    // The first round has about 64 sites.
    let first = (sites.len() / 64).checked_ilog2().unwrap_or(0) / 3;
    (0..=first).rev().flat_map(move |r| sites.clone().filter(move |&site| round(site).min(first) == r))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_site_has_its_turn() {
        for n in [0, 1, 63, 64, 1000, 100_000] {
            let mut sites: Vec<usize> = rounds(6..6 + n).collect();
            if n == 100_000 {
                let last = sites.iter().rev().take_while(|&&s| round(s) == 0).count();
                assert!((86_000..89_000).contains(&last), "{last}");
            }
            sites.sort_unstable();
            assert!(sites.into_iter().eq(6..6 + n));
        }
    }
}
