//! Topological order of nodes.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Sorts `0..keys.len()` so that each index comes after the indices that it reads. Ties are broken by the smallest key.
/// `reads[i]` lists the indices that `i` reads.
///
/// # Errors
/// A circle, each member once in the order of the links, starting with the smallest key.
pub(crate) fn topological<K: Ord>(keys: &[K], reads: &[Vec<usize>]) -> Result<Vec<usize>, Vec<usize>> {
    let mut readers = vec![Vec::new(); keys.len()];
    // Number of links into each index from indices that are not sorted yet.
    let mut in_degrees: Vec<usize> = vec![0; keys.len()];
    for (reader, sources) in reads.iter().enumerate() {
        for &source in sources {
            readers[source].push(reader);
            in_degrees[reader] += 1;
        }
    }
    let mut ready: BinaryHeap<Reverse<(&K, usize)>> = (0..keys.len())
        .filter(|&index| in_degrees[index] == 0)
        .map(|index| Reverse((&keys[index], index)))
        .collect();
    let mut order = Vec::with_capacity(keys.len());
    while let Some(Reverse((_, index))) = ready.pop() {
        order.push(index);
        for &reader in &readers[index] {
            in_degrees[reader] -= 1;
            if in_degrees[reader] == 0 {
                ready.push(Reverse((&keys[reader], reader)));
            }
        }
    }
    if order.len() == keys.len() {
        Ok(order)
    } else {
        Err(circle(keys, reads, &in_degrees))
    }
}

/// Finds a circle by walking against the links among the nodes that could not be sorted. Each of them reads another one, so
/// the walk must close.
fn circle<K: Ord>(keys: &[K], reads: &[Vec<usize>], in_degrees: &[usize]) -> Vec<usize> {
    let is_unsorted = |index: &usize| in_degrees[*index] > 0;
    let Some(mut at) = (0..keys.len()).filter(is_unsorted).min_by_key(|&index| &keys[index]) else {
        return Vec::new();
    };
    let mut step_of = vec![None; keys.len()];
    let mut walk = Vec::new();
    loop {
        if let Some(first) = step_of[at] {
            walk.drain(..first);
            break;
        }
        step_of[at] = Some(walk.len());
        walk.push(at);
        match reads[at]
            .iter()
            .copied()
            .filter(is_unsorted)
            .min_by_key(|&index| &keys[index])
        {
            Some(source) => at = source,
            None => return walk,
        }
    }
    walk.reverse();
    let smallest = (0..walk.len()).min_by_key(|&step| &keys[walk[step]]).unwrap_or(0);
    walk.rotate_left(smallest);
    walk
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_are_broken_by_name() {
        let keys = ["d", "c", "b", "a"];
        assert_eq!(
            topological(&keys, &[vec![], vec![], vec![], vec![]]),
            Ok(vec![3, 2, 1, 0])
        );
        assert_eq!(
            topological(&keys, &[vec![], vec![], vec![0], vec![2]]),
            Ok(vec![1, 0, 2, 3])
        );
    }

    #[test]
    fn a_circle_is_listed_in_the_order_of_the_links() {
        // b → c → a → b, and d reads a.
        let keys = ["a", "b", "c", "d"];
        assert_eq!(
            topological(&keys, &[vec![2], vec![0], vec![1], vec![0]]),
            Err(vec![0, 1, 2])
        );
    }
}
