//! Detection of components that are the same in all texels, during reading of a plane for another component.

use std::array;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// Components of the texels that were read so far by any number of threads. With it, a plane of three constant components
/// is read only once.
#[derive(Debug, Default)]
pub(super) struct Sameness {
    /// Any one of the texels; empty before the first.
    texel: OnceLock<[f32; 4]>,
    varies: [AtomicBool; 4],
}

impl Sameness {
    /// Records a texel, and returns it.
    pub(super) fn noted(&self, texel: [f32; 4]) -> [f32; 4] {
        let known = self.texel.get_or_init(|| texel);
        for ((one, other), varies) in texel.iter().zip(known).zip(&self.varies) {
            // Compares bits, since −0 and 0 differ. A flag that is already set is not written again, which would slow down
            // the other threads.
            if one.to_bits() != other.to_bits() && !varies.load(Ordering::Relaxed) {
                varies.store(true, Ordering::Relaxed);
            }
        }
        texel
    }

    /// Returns a texel that equals all others in some components from `first` on; `None` if one of these varies, or if no texel was read.
    pub(super) fn of(&self, first: usize, components: usize) -> Option<[f32; 4]> {
        let varies: [bool; 4] = array::from_fn(|at| self.varies[at].load(Ordering::Relaxed));
        let is_same = !varies.iter().skip(first).take(components).any(|varies| *varies);
        self.texel.get().copied().filter(|_| is_same)
    }
}

#[cfg(test)]
mod tests {
    use rayon::prelude::*;

    use super::*;

    #[test]
    fn components_are_the_same_until_one_texel_differs() {
        let seen = Sameness::default();
        assert_eq!(seen.of(0, 1), None, "nothing was read");
        (0..1000).into_par_iter().for_each(|at| {
            let _ = seen.noted([0.5, at as f32, 1.0, if at == 700 { -0.0 } else { 0.0 }]);
        });
        let same = seen.of(0, 1).expect("0.5 everywhere");
        assert_eq!([same[0], same[2]], [0.5, 1.0]);
        assert_eq!([seen.of(1, 1), seen.of(0, 3), seen.of(3, 1)], [None; 3]);
        assert_eq!(seen.of(2, 1), Some(same));
    }
}
