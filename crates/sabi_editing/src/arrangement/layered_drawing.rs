//! Layered graph drawing: columns by the longest path to an end, rows by the mean position of the neighbors (Sugiyama,
//! Tagawa and Toda, 1981).

use petgraph::algo::toposort;
use petgraph::graph::{DiGraph, NodeIndex};

/// Space between columns, canvas points.
const COLUMN_GAP: f32 = 80.0;
/// Space between boxes of a column, canvas points.
const ROW_GAP: f32 = 30.0;
/// Number of sweeps that sort rows by the positions of their neighbors, alternately from outputs to sources and back.
const SWEEPS: usize = 8;

/// Box that is placed; sizes in canvas points.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LayoutBox {
    pub(crate) width: f32,
    pub(crate) height: f32,
    /// Boxes that it reads, by index, without cycles.
    pub(crate) reads: Vec<usize>,
}

impl AsRef<[usize]> for LayoutBox {
    fn as_ref(&self) -> &[usize] {
        &self.reads
    }
}

/// Computes the upper left corners of the boxes, relative to that of their bounding box.
pub(crate) fn lay_out(boxes: &[LayoutBox]) -> Vec<[f32; 2]> {
    let readers = readers_of(boxes);
    let columns = columns_of(boxes, &readers);
    let last = columns.iter().copied().max().unwrap_or(0);
    let mut ranks: Vec<Vec<usize>> = vec![Vec::new(); last + 1];
    for (at, column) in columns.iter().enumerate() {
        ranks[*column].push(at);
    }
    let mut middles = vec![0.0; boxes.len()];
    for rank in &ranks {
        stack(rank, boxes, &mut middles);
    }
    for sweep in 0..SWEEPS {
        // Start from the outputs, towards the sources: the outputs on the right matter most.
        let is_back = sweep % 2 == 0;
        let order: Vec<usize> = if is_back {
            (0..=last).rev().collect()
        } else {
            (0..=last).collect()
        };
        for column in order {
            let near: &dyn Fn(usize) -> Vec<usize> = if is_back {
                &|at: usize| readers[at].clone()
            } else {
                &|at: usize| boxes[at].reads.clone()
            };
            let wanted: Vec<f32> = (0..boxes.len())
                .map(|at| mean(&near(at), &middles).unwrap_or(middles[at]))
                .collect();
            ranks[column].sort_by(|one, other| wanted[*one].total_cmp(&wanted[*other]).then(one.cmp(other)));
            spread(&ranks[column], boxes, &wanted, &mut middles);
        }
    }
    let top = (0..boxes.len())
        .map(|at| middles[at] - boxes[at].height / 2.0)
        .fold(f32::INFINITY, f32::min);
    let lefts = lefts_of(&ranks, boxes);
    let place = |at: usize| [lefts[columns[at]], middles[at] - boxes[at].height / 2.0 - top];
    (0..boxes.len()).map(place).collect()
}

/// Left edges of the columns, each as wide as its widest box, with [`COLUMN_GAP`] between them.
fn lefts_of(ranks: &[Vec<usize>], boxes: &[LayoutBox]) -> Vec<f32> {
    let widest = |rank: &Vec<usize>| rank.iter().map(|at| boxes[*at].width).fold(0.0, f32::max);
    let begin = |left: &mut f32, rank: &Vec<usize>| {
        let begins = *left;
        *left += widest(rank) + COLUMN_GAP;
        Some(begins)
    };
    ranks.iter().scan(0.0, begin).collect()
}

fn readers_of(boxes: &[LayoutBox]) -> Vec<Vec<usize>> {
    let mut readers = vec![Vec::new(); boxes.len()];
    for (at, boxed) in boxes.iter().enumerate() {
        for source in &boxed.reads {
            readers[*source].push(at);
        }
    }
    readers
}

/// Lists boxes so that each comes after those that it reads; `None` if they read each other in a cycle.
pub(crate) fn order_of(reads: &[impl AsRef<[usize]>]) -> Option<Vec<usize>> {
    let mut net = DiGraph::<(), ()>::with_capacity(reads.len(), 0);
    for _ in reads {
        net.add_node(());
    }
    for (at, sources) in reads.iter().enumerate() {
        for source in sources.as_ref() {
            net.add_edge(NodeIndex::new(*source), NodeIndex::new(at), ());
        }
    }
    let order = toposort(&net, None).ok()?;
    Some(order.into_iter().map(NodeIndex::index).collect())
}

/// Column of each box, counted from the left: every box is as far right as its readers allow.
fn columns_of(boxes: &[LayoutBox], readers: &[Vec<usize>]) -> Vec<usize> {
    let order = order_of(boxes).unwrap_or_else(|| unreachable!("boxes read each other without cycles"));
    let mut to_end = vec![0_usize; boxes.len()];
    for at in order.into_iter().rev() {
        to_end[at] = readers[at].iter().map(|reader| to_end[*reader] + 1).max().unwrap_or(0);
    }
    let longest = to_end.iter().copied().max().unwrap_or(0);
    to_end.into_iter().map(|steps| longest - steps).collect()
}

/// Returns the mean of the vertical middles of these boxes; `None` for no boxes.
fn mean(of: &[usize], middles: &[f32]) -> Option<f32> {
    let sum: f32 = of.iter().map(|at| middles[*at]).sum();
    (!of.is_empty()).then(|| sum / of.len() as f32)
}

/// Stacks boxes of a column, centered on 0.
fn stack(rank: &[usize], boxes: &[LayoutBox], middles: &mut [f32]) {
    let height: f32 = rank.iter().map(|at| boxes[*at].height + ROW_GAP).sum();
    let mut top = -height / 2.0;
    for at in rank {
        middles[*at] = top + boxes[*at].height / 2.0;
        top += boxes[*at].height + ROW_GAP;
    }
}

/// Moves boxes of a column to their wanted positions. Boxes that would overlap form a block, which moves by their mean distance.
fn spread(rank: &[usize], boxes: &[LayoutBox], wanted: &[f32], middles: &mut [f32]) {
    // Blocks of adjacent boxes: the middle of the block's first box, and the boxes.
    let mut blocks: Vec<(f32, Vec<usize>)> = Vec::new();
    for at in rank {
        blocks.push((wanted[*at], vec![*at]));
        while blocks.len() > 1 {
            let (above, below) = (&blocks[blocks.len() - 2], &blocks[blocks.len() - 1]);
            let lowest = above.0 + offsets(&above.1, boxes).last().copied().unwrap_or(0.0);
            let [Some(one), Some(other)] = [above.1.last(), below.1.first()] else {
                break;
            };
            if below.0 - lowest >= distance(*one, *other, boxes) {
                break;
            }
            let joined: Vec<usize> = above.1.iter().chain(&below.1).copied().collect();
            let steps = offsets(&joined, boxes);
            let sum: f32 = joined.iter().zip(&steps).map(|(at, step)| wanted[*at] - step).sum();
            let first = sum / joined.len() as f32;
            blocks.truncate(blocks.len() - 2);
            blocks.push((first, joined));
        }
    }
    for (first, block) in &blocks {
        for (at, step) in block.iter().zip(offsets(block, boxes)) {
            middles[*at] = first + step;
        }
    }
}

/// Returns the offsets of the middles of a block's boxes from the middle of its first box, packed as tightly as possible.
fn offsets(block: &[usize], boxes: &[LayoutBox]) -> Vec<f32> {
    let mut offset = 0.0;
    let mut offsets = vec![0.0];
    for pair in block.windows(2) {
        offset += distance(pair[0], pair[1], boxes);
        offsets.push(offset);
    }
    offsets
}

/// Returns the smallest allowed distance between the middles of two boxes of a column.
fn distance(one: usize, other: usize, boxes: &[LayoutBox]) -> f32 {
    (boxes[one].height + boxes[other].height) / 2.0 + ROW_GAP
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxed(height: f32, reads: &[usize]) -> LayoutBox {
        LayoutBox {
            width: 200.0,
            height,
            reads: reads.to_vec(),
        }
    }

    #[test]
    fn a_box_is_right_of_all_boxes_it_reads_and_level_with_a_single_source() {
        let boxes = [boxed(100.0, &[]), boxed(100.0, &[0]), boxed(60.0, &[1, 0])];
        let places = lay_out(&boxes);
        assert!(places[0][0] < places[1][0] && places[1][0] < places[2][0], "{places:?}");
    }

    #[test]
    fn boxes_of_a_column_never_overlap() {
        let boxes: Vec<LayoutBox> = (0..9)
            .map(|at| boxed(50.0 + 20.0 * at as f32, &[]))
            .chain([boxed(400.0, &[0, 1, 2, 3]), boxed(80.0, &[4, 5, 6, 7, 8, 0])])
            .collect();
        let places = lay_out(&boxes);
        for one in 0..boxes.len() {
            for other in one + 1..boxes.len() {
                let is_apart = places[one][0] != places[other][0]
                    || places[one][1] + boxes[one].height + ROW_GAP <= places[other][1] + 0.01
                    || places[other][1] + boxes[other].height + ROW_GAP <= places[one][1] + 0.01;
                assert!(is_apart, "{one} and {other} touch: {places:?}");
            }
        }
    }

    #[test]
    fn an_empty_graph_has_an_empty_layout() {
        assert!(lay_out(&[]).is_empty());
    }
}
