//! Effective seeds: seeds of the document, the groups and the node in one number.

/// One round of PCG as a hash of a 32-bit number (PCG-RXS-M-XS-32; Jarzynski and Olano 2020, JCGT 9(3)).
pub fn pcg(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// The effective seed: the node's own, hashed with those of the document and of the groups around it.
pub(crate) fn effective(outer: &[u32], own: u32) -> u32 {
    let outer = outer.iter().fold(0_u32, |hash, seed| pcg(hash ^ *seed));
    pcg(outer ^ own)
}

#[cfg(test)]
mod tests {
    use super::{effective, pcg};

    #[test]
    fn the_hash_never_changes() {
        // Computed independently of this code.
        assert_eq!([pcg(0), pcg(1), pcg(2)], [129_708_002, 2_831_084_092, 2_055_130_248]);
    }

    #[test]
    fn seeds_at_different_depths_are_different() {
        assert_ne!(effective(&[1], 2), effective(&[2], 1));
        assert_ne!(effective(&[0], 2), effective(&[0, 0], 2));
    }
}
