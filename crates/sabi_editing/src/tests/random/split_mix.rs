//! Random numbers that are the same in every run.

use std::collections::BTreeMap;

use sabi_graph::Value;

/// Generator of random numbers (SplitMix64, Steele, Lea and Flood 2014).
pub(super) struct SplitMix64(pub(super) u64);

impl SplitMix64 {
    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    pub(super) fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }

    pub(super) fn one_in(&mut self, many: usize) -> bool {
        self.below(many) == 0
    }

    pub(super) fn pick<T: Clone>(&mut self, from: &[T]) -> Option<T> {
        from.get(self.below(from.len())).cloned()
    }

    pub(super) fn word(&mut self, from: &[&str]) -> String {
        self.pick(from).unwrap_or_default().to_owned()
    }

    pub(super) fn place(&mut self) -> [f32; 2] {
        match self.below(200) {
            0 => [f32::NAN, 0.0],
            1 => [f32::MAX, -f32::MAX],
            _ => [0, 1].map(|_| self.below(4000) as f32 - 2000.0),
        }
    }

    /// Returns values that some parameters accept, and some that no parameter accepts.
    pub(super) fn value(&mut self) -> Option<Value> {
        let text = [
            "", "multiply", "normal", "none", "#ff8000", "../a.png", "a b.png", "v", "\u{7}", "🙂",
        ];
        Some(match self.below(12) {
            0 => return None,
            1 => Value::Null,
            2 => Value::Bool(self.one_in(2)),
            3 => Value::Number(f64::NAN),
            4 => Value::Number(f64::INFINITY),
            5 => Value::Number(-1.0e30),
            6 => Value::Text(self.word(&text)),
            7 => Value::List(
                (0..self.below(5))
                    .map(|_| Value::Number(self.below(9) as f64))
                    .collect(),
            ),
            8 => Value::Object(BTreeMap::from([("x".to_owned(), Value::Null)])),
            _ => Value::Number(self.below(1000) as f64 / 500.0),
        })
    }
}
