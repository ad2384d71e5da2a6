//! Rows of the bench's table.

use std::time::{Duration, Instant};

pub(crate) fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1000.0
}

/// Median and maximum of some times, milliseconds.
pub(crate) fn spread(mut times: Vec<f64>) -> [f64; 2] {
    times.sort_by(f64::total_cmp);
    [times.len() / 2, times.len() - 1].map(|at| times.get(at).copied().unwrap_or(f64::NAN))
}

pub(crate) fn row(what: &str, times: Vec<f64>, aim: &str) {
    let [middle, worst] = spread(times);
    println!("| {what} | {middle:.1} ms | {worst:.1} ms | {aim} |");
}

pub(crate) fn rate(what: &str, count: usize, began: Instant, aim: &str) {
    let rate = count as f64 / began.elapsed().as_secs_f64();
    println!("| {what} | {rate:.1} a second | | {aim} |");
}
