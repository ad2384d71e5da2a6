//! Order of the nodes of a net of links, and its cycles.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use petgraph::Incoming;
use petgraph::algo::{dijkstra, kosaraju_scc};
use petgraph::stable_graph::{NodeIndex, StableDiGraph};
use petgraph::visit::{EdgeRef, IntoEdgeReferences, NodeIndexable, Reversed};

/// Creates a net of `count` nodes with edges between their indices, each from a node to one that reads it.
pub(crate) fn net(count: usize, edges: impl IntoIterator<Item = [usize; 2]>) -> StableDiGraph<(), ()> {
    let mut net = StableDiGraph::with_capacity(count, 0);
    for _ in 0..count {
        net.add_node(());
    }
    for [from, to] in edges {
        net.add_edge(NodeIndex::new(from), NodeIndex::new(to), ());
    }
    net
}

/// Lists all nodes, each after those with an edge to it; ties are broken by the smallest key. `None` if edges form a cycle.
///
/// `petgraph::algo::toposort` breaks ties by the history of the net, and orders of equal documents must be equal.
pub(crate) fn topological<N, E, K: Ord>(
    net: &StableDiGraph<N, E>,
    key: impl Fn(NodeIndex) -> K,
) -> Option<Vec<NodeIndex>> {
    // Number of edges into each node from nodes that are not listed yet.
    let mut in_degrees = vec![0_usize; net.node_bound()];
    for edge in net.edge_references() {
        in_degrees[edge.target().index()] += 1;
    }
    let mut ready: BinaryHeap<_> = net.externals(Incoming).map(|at| Reverse((key(at), at))).collect();
    let mut order = Vec::with_capacity(net.node_count());
    while let Some(Reverse((_, at))) = ready.pop() {
        order.push(at);
        for reader in net.neighbors(at) {
            in_degrees[reader.index()] -= 1;
            if in_degrees[reader.index()] == 0 {
                ready.push(Reverse((key(reader), reader)));
            }
        }
    }
    (order.len() == net.node_count()).then_some(order)
}

/// Lists the nodes of a cycle, each once in the order of the edges; `None` if there is no cycle. It is the shortest cycle
/// through the node with the smallest key on any cycle, and starts there.
pub(crate) fn cycle<N, E, K: Ord>(net: &StableDiGraph<N, E>, key: impl Fn(NodeIndex) -> K) -> Option<Vec<NodeIndex>> {
    // Not `tarjan_scc`, which recurses as deep as a chain of nodes is long.
    let components = kosaraju_scc(net).into_iter();
    let on_cycles = components.filter(|nodes| nodes.len() > 1 || net.contains_edge(nodes[0], nodes[0]));
    let first = on_cycles.flatten().min_by_key(|&at| key(at))?;
    let mut nodes = shortest_path(net, key, [first, first])?;
    nodes.pop();
    Some(nodes)
}

/// Lists the nodes of the shortest path between two nodes, with both ends; `None` if there is none. From a node to itself it
/// has at least one edge. Ties are broken by the smallest key, from the start on.
pub(crate) fn shortest_path<N, E, K: Ord>(
    net: &StableDiGraph<N, E>,
    key: impl Fn(NodeIndex) -> K,
    [start, end]: [NodeIndex; 2],
) -> Option<Vec<NodeIndex>> {
    let steps_to_end = dijkstra(Reversed(net), end, None, |_| 1_usize);
    let mut path = vec![start];
    let mut at = start;
    loop {
        let next = net.neighbors(at);
        let next = next.filter_map(|next| Some((*steps_to_end.get(&next)?, key(next), next)));
        let (steps, _, next) = next.min()?;
        path.push(next);
        if steps == 0 {
            return Some(path);
        }
        at = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEYS: [&str; 4] = ["d", "c", "b", "a"];

    fn keys(found: Option<Vec<NodeIndex>>) -> Option<String> {
        Some(found?.into_iter().map(|at| KEYS[at.index()]).collect())
    }

    fn ordered(edges: &[[usize; 2]]) -> Option<String> {
        keys(topological(&net(4, edges.iter().copied()), |at| KEYS[at.index()]))
    }

    fn cycle_of(edges: &[[usize; 2]]) -> Option<String> {
        keys(cycle(&net(4, edges.iter().copied()), |at| KEYS[at.index()]))
    }

    #[test]
    fn ties_are_broken_by_name() {
        assert_eq!(ordered(&[]).as_deref(), Some("abcd"));
        assert_eq!(ordered(&[[0, 2], [2, 3]]).as_deref(), Some("cdba"));
    }

    #[test]
    fn a_circle_is_listed_in_the_order_of_the_links() {
        // a → c → b → a, and d reads a.
        let edges = [[3, 1], [1, 2], [2, 3], [3, 0]];
        assert_eq!(ordered(&edges), None);
        assert_eq!(cycle_of(&edges).as_deref(), Some("acb"));
        assert_eq!(cycle_of(&edges[1..]), None);
        assert_eq!(cycle_of(&[[3, 2], [1, 1]]).as_deref(), Some("c"));
    }

    #[test]
    fn of_several_circles_the_shortest_through_the_first_name_is_listed() {
        let edges = [[3, 0], [0, 1], [1, 3], [3, 2], [2, 3], [0, 0]];
        assert_eq!(cycle_of(&edges).as_deref(), Some("ab"));
    }

    #[test]
    fn a_long_chain_does_not_exhaust_the_stack() {
        let count = 200_000;
        let links = (1..count).map(|at| [at - 1, at]);
        let net = net(count, links.chain([[count - 1, 0]]));
        assert_eq!(cycle(&net, NodeIndex::index).map(|nodes| nodes.len()), Some(count));
    }
}
