//! Failures to flatten a document.

use crate::problem::Problem;

/// Failure to flatten a document.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FlattenError {
    /// The requested variant does not exist.
    #[error("there is no variant {name}{hint}; this graph has {known}")]
    NoSuchVariant {
        /// The name, quoted.
        name: String,
        /// The nearest existing name, as a question.
        hint: String,
        /// All of them, quoted.
        known: String,
    },
    /// The name of an override names neither an exposed knob nor a parameter.
    #[error("nothing is called {name}{hint}; set an exposed knob ({known}) or a node's parameter as node.param")]
    NoSuchKnob {
        /// The name, quoted.
        name: String,
        /// The nearest existing name, as a question.
        hint: String,
        /// All exposed knobs, quoted.
        known: String,
    },
    /// A number outside a knob's range.
    #[error("{knob} is {value}, but goes from {low} to {high}; choose a value in that range")]
    OutOfRange {
        /// The knob, quoted.
        knob: String,
        /// The given number.
        value: String,
        /// Lower end.
        low: String,
        /// Upper end.
        high: String,
    },
    /// A knob with a range was given a value that is not a number.
    #[error("{knob} takes a number from {low} to {high}, not {value}")]
    NotANumber {
        /// The knob, quoted.
        knob: String,
        /// Lower end.
        low: String,
        /// Upper end.
        high: String,
        /// The given value.
        value: String,
    },
    /// An instance of a group that does not exist.
    #[error("node {instance} is an instance of group {name}, which is not there{hint}")]
    NoSuchGroup {
        /// The instance, quoted.
        instance: String,
        /// The group, quoted.
        name: String,
        /// The nearest existing name, as a question.
        hint: String,
    },
    /// A group instance without a group.
    #[error("node {instance} is a group instance but names no group")]
    GroupNotNamed {
        /// The instance, quoted.
        instance: String,
    },
    /// A group file that could not be read.
    #[error("node {instance} needs the group file {file}, which cannot be read: {why}")]
    GroupFile {
        /// The instance, quoted.
        instance: String,
        /// The path relative to the document, quoted.
        file: String,
        /// The error of the reader, a sentence.
        why: String,
    },
    /// More group files than the limit.
    #[error("the graph uses more than {limit} group files; look for a folder that leads into itself")]
    TooManyFiles {
        /// The limit.
        limit: usize,
    },
    /// A group inside itself.
    #[error("a group cannot hold itself: {chain}; take one of these instances out")]
    Recursion {
        /// Groups, each containing an instance of the next.
        chain: String,
    },
    /// Instances nested deeper than the limit.
    #[error("groups stand inside each other more than {limit} deep; use fewer levels")]
    TooDeep {
        /// The limit.
        limit: usize,
    },
    /// More nodes or bytes of parameters than the limits.
    #[error(
        "with all groups opened the graph has more than {count} nodes, or 256 MiB of parameters; use fewer instances"
    )]
    TooLarge {
        /// The limit of nodes.
        count: usize,
    },
    /// An exposed knob with the name of a knob that every instance has.
    #[error("the group of node {instance} exposes a knob {knob:?}, which every group instance has already; rename it")]
    ReservedKnob {
        /// The instance, quoted.
        instance: String,
        /// The knob.
        knob: &'static str,
    },
    /// An invalid seed, scale or variant of an instance.
    #[error("the {knob} of group instance {instance} must be {expected}, not {value}")]
    BadInstanceKnob {
        /// The instance, quoted.
        instance: String,
        /// The knob.
        knob: &'static str,
        /// Expected value.
        expected: &'static str,
        /// Found value.
        value: String,
    },
    /// Scale knobs whose product is zero or not finite.
    #[error(
        "the Scale knobs down to group instance {instance} multiply to nothing or without bounds; bring them nearer to 1"
    )]
    ScaleOverflow {
        /// The instance, quoted.
        instance: String,
    },
    /// A parameter that the group of an instance does not expose.
    #[error("group instance {instance} has no knob {name}{hint}; it has {known}")]
    NoSuchInstanceKnob {
        /// The instance, quoted.
        instance: String,
        /// The name, quoted.
        name: String,
        /// The nearest, as a question.
        hint: String,
        /// All of them, quoted.
        known: String,
    },
    /// A link into an input that an instance or reroute does not have.
    #[error("node {node} has no input {input}{hint}; it has {known}")]
    NoSuchInput {
        /// The node, quoted.
        node: String,
        /// The input, quoted.
        input: String,
        /// The nearest, as a question.
        hint: String,
        /// All of them, quoted.
        known: String,
    },
    /// A link from an output that a group does not have.
    #[error("group instance {instance} has no output {port}{hint}; it has {known}")]
    NoSuchOutput {
        /// The instance, quoted.
        instance: String,
        /// The output, quoted.
        port: String,
        /// The nearest, as a question.
        hint: String,
        /// All of them, quoted.
        known: String,
    },
    /// A link from a group with several outputs that names none of them.
    #[error("a link from group instance {instance} must name one of its outputs as node.output; it has {known}")]
    OutputNotNamed {
        /// The instance, quoted.
        instance: String,
        /// All of them, quoted.
        known: String,
    },
    /// A reroute has one output without a name.
    #[error("node {node} is a reroute and has no output {port}; link from the node's id alone")]
    ReroutePort {
        /// The node, quoted.
        node: String,
        /// The output, quoted.
        port: String,
    },
    /// A kind with a version that is not a number.
    #[error("node {node} has the kind {kind}; after the @ stands a version from 1 up, as in \"noise/simplex@2\"")]
    BadVersion {
        /// The node, quoted.
        node: String,
        /// The kind, quoted.
        kind: String,
    },
    /// Links that lead in a circle.
    #[error("the nodes {nodes} feed each other in a circle; remove one of their links")]
    Circle {
        /// The nodes, quoted.
        nodes: String,
    },
    /// A value that cannot be set.
    #[error(transparent)]
    Problem(#[from] Problem),
}
