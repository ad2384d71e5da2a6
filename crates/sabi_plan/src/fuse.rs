//! Groups nodes into kernels.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use sabi_graph::PortType;
use sabi_nodes::kind::{Cost, Reads, Shape};
use sabi_nodes::link::StoredLayout;

use crate::request::{Limits, Mode};
use crate::resolved_graph::{Behavior, ResolvedGraph};

/// A result: node, and index of its output.
pub(crate) type ResultRef = (usize, usize);

/// Nodes that are evaluated together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FusionGroup {
    /// Results filled by the engine.
    Source { node: usize, outputs: Vec<usize> },
    /// A node that reads stored results as textures.
    Field { node: usize, outputs: Vec<usize> },
    /// A node whose results are means over rays.
    Rays { node: usize, outputs: Vec<usize> },
    /// A node that reads a survey of the whole surface.
    Survey { node: usize, outputs: Vec<usize> },
    /// Point nodes in evaluation order, each with its needed results.
    Points(Vec<(usize, Vec<usize>)>),
}

impl FusionGroup {
    /// Results that this group makes.
    pub(crate) fn values(&self) -> Vec<ResultRef> {
        match self {
            FusionGroup::Source { node, outputs }
            | FusionGroup::Field { node, outputs }
            | FusionGroup::Rays { node, outputs }
            | FusionGroup::Survey { node, outputs } => outputs.iter().map(|output| (*node, *output)).collect(),
            FusionGroup::Points(members) => members
                .iter()
                .flat_map(|(node, outputs)| outputs.iter().map(|output| (*node, *output)))
                .collect(),
        }
    }
}

/// For each value, the nodes that read it, once for each input.
pub(crate) type ResultReaders = BTreeMap<ResultRef, Vec<usize>>;

/// Readers of each value in the wanted part of a graph.
pub(crate) fn readers(resolved: &ResolvedGraph<'_>) -> ResultReaders {
    let mut readers = ResultReaders::new();
    for node in &resolved.order {
        let inputs = resolved.nodes[*node]
            .iter()
            .flat_map(|ready| ready.inputs.iter().flatten());
        for input in inputs {
            readers.entry((input.node, input.output)).or_default().push(*node);
        }
    }
    readers
}

/// Divides the wanted part of a graph into groups, in evaluation order.
pub(crate) fn groups(
    resolved: &ResolvedGraph<'_>,
    readers: &ResultReaders,
    wanted: &[ResultRef],
    mode: Mode,
    limits: &Limits,
) -> Vec<FusionGroup> {
    let needed: BTreeSet<ResultRef> = readers.keys().chain(wanted).copied().collect();
    let outputs_of = |node: usize| {
        needed
            .range((node, 0)..(node + 1, 0))
            .map(|(_, output)| *output)
            .collect::<Vec<_>>()
    };
    let mut groups = Vec::new();
    let mut points = Vec::new();
    for node in resolved.order.iter().copied() {
        let Some(ready) = &resolved.nodes[node] else { continue };
        let outputs = outputs_of(node);
        match ready.behavior {
            Behavior::Sink(_) => {}
            _ if outputs.is_empty() => {}
            Behavior::Source(_) => groups.push(FusionGroup::Source { node, outputs }),
            Behavior::Shader(kind) if kind.shape == Shape::Field => groups.push(FusionGroup::Field { node, outputs }),
            Behavior::Shader(kind) if kind.shape == Shape::Ray => groups.push(FusionGroup::Rays { node, outputs }),
            Behavior::Shader(kind) if kind.shape == Shape::Survey => groups.push(FusionGroup::Survey { node, outputs }),
            Behavior::Shader(_) => points.push((node, outputs)),
        }
    }
    match mode {
        Mode::Interactive => {
            let single = |(node, outputs): (usize, Vec<usize>)| {
                outputs
                    .into_iter()
                    .map(move |output| FusionGroup::Points(vec![(node, vec![output])]))
            };
            groups.extend(points.into_iter().flat_map(single));
        }
        Mode::Bake { fuse: false } => groups.extend(points.into_iter().map(|point| FusionGroup::Points(vec![point]))),
        Mode::Bake { fuse: true } => {
            for region in regions(resolved, points) {
                cut(resolved, readers, region, wanted, limits, &mut groups);
            }
        }
    }
    groups
}

/// Regions of point nodes that are connected without a stored result in between.
///
/// Each node gets the largest number of stored results on a path from it to a wanted result. Nodes with the same number
/// never depend on each other through a texture, so connected nodes with the same number form a region.
fn regions(resolved: &ResolvedGraph<'_>, points: Vec<(usize, Vec<usize>)>) -> Vec<Vec<(usize, Vec<usize>)>> {
    let is_point: BTreeSet<usize> = points.iter().map(|(node, _)| *node).collect();
    let mut distance: BTreeMap<usize, u32> = BTreeMap::new();
    for node in resolved.order.iter().rev() {
        let Some(ready) = &resolved.nodes[*node] else { continue };
        let own = *distance.entry(*node).or_insert(0);
        for input in ready.inputs.iter().flatten() {
            let stored = !(is_point.contains(node) && is_point.contains(&input.node) && input.reads == Reads::Value);
            let through = own + u32::from(stored);
            let known = distance.entry(input.node).or_insert(0);
            *known = (*known).max(through);
        }
    }
    let mut region_of: BTreeMap<usize, usize> = BTreeMap::new();
    let mut regions: Vec<Vec<usize>> = Vec::new();
    for (node, _) in &points {
        let Some(ready) = &resolved.nodes[*node] else { continue };
        let beside = ready
            .inputs
            .iter()
            .flatten()
            .filter(|input| is_point.contains(&input.node) && distance.get(&input.node) == distance.get(node));
        let joined: BTreeSet<usize> = beside.filter_map(|input| region_of.get(&input.node).copied()).collect();
        let home = joined.first().copied().unwrap_or_else(|| {
            regions.push(Vec::new());
            regions.len() - 1
        });
        for other in joined.iter().skip(1) {
            let moved = std::mem::take(&mut regions[*other]);
            region_of.extend(moved.iter().map(|node| (*node, home)));
            regions[home].extend(moved);
        }
        regions[home].push(*node);
        region_of.insert(*node, home);
    }
    let place: BTreeMap<usize, usize> = points.iter().enumerate().map(|(at, (node, _))| (*node, at)).collect();
    let rank: BTreeMap<usize, usize> = large_first(resolved)
        .into_iter()
        .enumerate()
        .map(|(at, node)| (node, at))
        .collect();
    regions.retain(|region| !region.is_empty());
    regions
        .into_iter()
        .map(|mut region| {
            region.sort_by_key(|node| rank[node]);
            region.into_iter().map(|node| points[place[&node]].clone()).collect()
        })
        .collect()
}

/// Returns the resolved nodes depth first, inputs before readers, and the input with the largest value first. So a
/// region that has to be cut follows a material through its layers, and the masks of a layer are not stored while the
/// layers below it are computed. Among inputs of equal size, the one whose computation needs the most values at once is
/// first (Sethi and Ullman 1970).
fn large_first(resolved: &ResolvedGraph<'_>) -> Vec<usize> {
    let needs = needed_values(resolved);
    let fresh_inputs = |node: usize, seen: &BTreeSet<usize>| -> Vec<usize> {
        let mut inputs = inputs_of(resolved, node);
        inputs.retain(|(from, _)| !seen.contains(from));
        inputs.sort_by_key(|value| Reverse((planes(resolved, *value), needs[value.0])));
        inputs.into_iter().map(|(from, _)| from).collect()
    };
    let mut seen = BTreeSet::new();
    let mut order = Vec::new();
    // The last ones are read by no other node, or by earlier ones of these alone.
    for root in resolved.order.iter().rev() {
        // An explicit stack: graphs may be deeper than the stack of a thread.
        let mut stack = vec![(*root, false)];
        while let Some((node, inputs_done)) = stack.pop() {
            if inputs_done {
                order.push(node);
            } else if seen.insert(node) {
                stack.push((node, true));
                stack.extend(fresh_inputs(node, &seen).into_iter().rev().map(|from| (from, false)));
            }
        }
    }
    order
}

/// Values that a node reads.
fn inputs_of(resolved: &ResolvedGraph<'_>, node: usize) -> Vec<ResultRef> {
    let inputs = resolved.nodes[node]
        .iter()
        .flat_map(|ready| ready.inputs.iter().flatten());
    inputs.map(|input| (input.node, input.output)).collect()
}

/// Number of values that are needed at once to evaluate each node, as if no value had two readers.
fn needed_values(resolved: &ResolvedGraph<'_>) -> Vec<usize> {
    let mut needs = vec![0_usize; resolved.nodes.len()];
    for node in &resolved.order {
        let inputs: BTreeSet<usize> = inputs_of(resolved, *node).into_iter().map(|(from, _)| from).collect();
        let mut of_inputs: Vec<usize> = inputs.into_iter().map(|from| needs[from]).collect();
        of_inputs.sort_unstable_by_key(|need| Reverse(*need));
        let most = of_inputs.iter().enumerate().map(|(stored, need)| stored + need).max();
        needs[*node] = most.unwrap_or(1); // A node without inputs makes its own value.
    }
    needs
}

/// Cuts a region that exceeds the limits of a kernel: of the prefixes that fit and are no shorter than half of the longest one, that
/// which stores fewest bytes, then the rest.
fn cut(
    resolved: &ResolvedGraph<'_>,
    readers: &ResultReaders,
    mut region: Vec<(usize, Vec<usize>)>,
    wanted: &[ResultRef],
    limits: &Limits,
    groups: &mut Vec<FusionGroup>,
) {
    while !region.is_empty() {
        let fitting = fitting_prefixes(Prefix::new(resolved, readers, wanted), &region, limits);
        let rest = region.split_off(best_length(&fitting, region.len()));
        groups.push(FusionGroup::Points(std::mem::replace(&mut region, rest)));
    }
}

/// Prefix that fits into a kernel.
struct FittingPrefix {
    /// Number of its nodes.
    length: usize,
    /// Cost of compiling it.
    cost: Cost,
    work: u64,
    /// Bytes of a texel of all that it stores.
    stored_bytes: u64,
}

/// Prefixes of a region that fit into a kernel, from the shortest on.
fn fitting_prefixes(mut kernel: Prefix<'_, '_>, region: &[(usize, Vec<usize>)], limits: &Limits) -> Vec<FittingPrefix> {
    let mut fitting = Vec::new();
    for (count, (node, _)) in region.iter().enumerate() {
        kernel.add(*node);
        // Cost, work, parameters and loads only grow; the number of stores shrinks when the last reader of a result joins.
        let is_too_long = !kernel.cost.is_within(limits.cost) || kernel.work > limits.work;
        let is_too_large = kernel.block_bytes > limits.block_bytes;
        if is_too_long || is_too_large || kernel.loads > limits.sampled_textures {
            break;
        }
        if kernel.stores <= limits.storage_textures {
            fitting.push(FittingPrefix {
                length: count + 1,
                cost: kernel.cost,
                work: kernel.work,
                stored_bytes: kernel.stored_bytes,
            });
        }
    }
    fitting
}

/// Number of nodes of the best of the prefixes that fit a region of so many nodes.
fn best_length(fitting: &[FittingPrefix], all: usize) -> usize {
    let Some(longest) = fitting.last() else { return 1 };
    if longest.length == all {
        return all;
    }
    let is_half = |prefix: &&FittingPrefix| {
        let (cost, most) = (prefix.cost, longest.cost);
        2 * cost.all >= most.all && 2 * cost.straight >= most.straight && 2 * prefix.work >= longest.work
    };
    let best = fitting
        .iter()
        .filter(is_half)
        .min_by_key(|prefix| (prefix.stored_bytes, Reverse(prefix.length)));
    best.unwrap_or(longest).length
}

/// Prefix of a region with the cost and the bindings of its kernel.
struct Prefix<'a, 'k> {
    resolved: &'a ResolvedGraph<'k>,
    readers: &'a ResultReaders,
    wanted: &'a [ResultRef],
    inside: BTreeSet<usize>,
    loaded: BTreeSet<ResultRef>,
    /// Readers of each result that are not in the prefix yet.
    outside: BTreeMap<ResultRef, usize>,
    cost: Cost,
    work: u64,
    block_bytes: u64,
    loads: usize,
    stores: usize,
    /// Bytes of a texel of the stored planes.
    stored_bytes: u64,
}

impl<'a, 'k> Prefix<'a, 'k> {
    fn new(resolved: &'a ResolvedGraph<'k>, readers: &'a ResultReaders, wanted: &'a [ResultRef]) -> Self {
        Prefix {
            resolved,
            readers,
            wanted,
            inside: BTreeSet::new(),
            loaded: BTreeSet::new(),
            outside: BTreeMap::new(),
            cost: Cost::default(),
            work: 0,
            block_bytes: 0,
            loads: 0,
            stores: 0,
            stored_bytes: 0,
        }
    }

    fn add(&mut self, node: usize) {
        let Some(ready) = &self.resolved.nodes[node] else {
            return;
        };
        self.cost = self.cost.and(node_cost(self.resolved, node));
        self.work = self.work.saturating_add(node_work(self.resolved, node));
        // Each struct of the block, and each knob, takes a multiple of 16 bytes.
        let params = ready.params.len().next_multiple_of(16);
        self.block_bytes += (params + 16 * ready.knobs.len()) as u64;
        for input in ready.inputs.iter().flatten() {
            let value = (input.node, input.output);
            if !self.inside.contains(&input.node) {
                if self.loaded.insert(value) {
                    self.loads += planes(self.resolved, value);
                }
            } else if let Some(left) = self.outside.get_mut(&value) {
                *left -= 1;
                if *left == 0 && !self.wanted.contains(&value) {
                    self.stores -= planes(self.resolved, value);
                    self.stored_bytes -= bytes(self.resolved, value);
                }
            }
        }
        self.inside.insert(node);
        for (value, readers) in self.readers.range((node, 0)..(node + 1, 0)) {
            self.outside.insert(*value, readers.len());
            self.stores += planes(self.resolved, *value);
            self.stored_bytes += bytes(self.resolved, *value);
        }
        let unread = self
            .wanted
            .iter()
            .filter(|value| value.0 == node && !self.readers.contains_key(value));
        for value in unread {
            self.stores += planes(self.resolved, *value);
            self.stored_bytes += bytes(self.resolved, *value);
        }
    }
}

/// Cost of compiling a node, for the limit of kernels.
pub(crate) fn node_cost(resolved: &ResolvedGraph<'_>, node: usize) -> Cost {
    match resolved.nodes[node].as_ref().map(|ready| ready.behavior) {
        Some(Behavior::Shader(kind)) => kind.cost,
        _ => Cost::default(),
    }
}

/// Operations of a node for a texel, for the limit of work.
fn node_work(resolved: &ResolvedGraph<'_>, node: usize) -> u64 {
    match resolved.nodes[node].as_ref().map(|ready| ready.behavior) {
        Some(Behavior::Shader(kind)) => kind.work,
        _ => 0,
    }
}

/// Number of textures that a result takes.
fn planes(resolved: &ResolvedGraph<'_>, value: ResultRef) -> usize {
    stored(resolved, value).map_or(1, |stored| stored.planes().len().max(1))
}

/// Bytes of a texel of a result.
fn bytes(resolved: &ResolvedGraph<'_>, value: ResultRef) -> u64 {
    let planes = stored(resolved, value)
        .map(|stored| stored.planes())
        .unwrap_or_default();
    planes.iter().map(|plane| plane.format().texel_bytes()).sum()
}

/// A result in storage.
fn stored(resolved: &ResolvedGraph<'_>, (node, output): ResultRef) -> Option<StoredLayout> {
    let ready = resolved.nodes[node].as_ref()?;
    let (_, ty) = ready.output(output)?;
    let channels = match ty {
        PortType::Material => ready.channels.get(output)?.clone(),
        PortType::Mask | PortType::Color | PortType::Vector => Vec::new(),
    };
    Some(StoredLayout { ty, channels })
}
