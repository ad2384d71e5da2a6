//! Problems of a graph that can be found only when its kinds are known.

use std::fmt;

use sabi_graph::PortType;

use crate::request::FileFault;

/// A problem of a node, or of one of its ports or parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanError {
    /// Id of the node in the flat graph.
    pub node: String,
    /// Kind as written.
    pub kind: String,
    /// The problem.
    pub problem: Problem,
}

/// Kinds of problems.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// No file describes this kind.
    UnknownKind {
        /// The kind with the most similar name.
        nearest: Option<String>,
    },
    /// The file was written for a newer version of the kind.
    NewerKind {
        /// Version in the graph.
        wanted: u32,
        /// Version of the loaded file.
        loaded: u32,
    },
    /// The node has no such input.
    UnknownInput {
        /// Name in the graph.
        port: String,
        /// The most similar input.
        nearest: Option<String>,
    },
    /// A mask is linked to a parameter that is not read for each place.
    ParamWithoutMask {
        /// The parameter.
        param: String,
    },
    /// The node to which an input is linked has no result with this name.
    UnknownOutput {
        /// The input.
        port: String,
        /// The node it names.
        from: String,
        /// Name in the graph.
        output: String,
        /// The most similar result.
        nearest: Option<String>,
    },
    /// An input is linked to an output of a type that it does not accept.
    Mistyped {
        /// The input.
        port: String,
        /// Port type of the input.
        expected: PortType,
        /// The node that gives the output.
        from: String,
        /// Port type of the output.
        found: PortType,
    },
    /// A required input is not connected.
    MissingInput {
        /// The input.
        port: String,
        /// Port type of the input.
        expected: PortType,
    },
    /// The node has no such parameter.
    UnknownParam {
        /// Name in the graph.
        param: String,
        /// The most similar parameter.
        nearest: Option<String>,
    },
    /// A parameter's value does not fit.
    BadValue {
        /// The parameter.
        param: String,
        /// Expected value, to follow "takes".
        expected: String,
        /// Value in the graph.
        found: String,
    },
    /// The file that a parameter names cannot be used.
    BadFile(FileFault),
    /// The node has no result of that name, or none at all.
    NoSuchResult {
        /// Requested name.
        output: Option<String>,
        /// Results of the node.
        known: Vec<String>,
    },
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let PlanError { node, kind, problem } = self;
        write!(f, "{}", Sentence { node, kind, problem })?;
        match problem {
            Problem::UnknownKind { nearest }
            | Problem::UnknownInput { nearest, .. }
            | Problem::UnknownOutput { nearest, .. }
            | Problem::UnknownParam { nearest, .. } => did_you_mean(f, nearest),
            _ => Ok(()),
        }
    }
}

/// Sentence of a problem without the suggested name.
struct Sentence<'a> {
    node: &'a str,
    kind: &'a str,
    problem: &'a Problem,
}

impl fmt::Display for Sentence<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Sentence { node, kind, problem } = self;
        match problem {
            Problem::UnknownKind { .. } => {
                write!(
                    f,
                    "node '{node}' is of kind '{kind}', which no loaded node file describes"
                )
            }
            Problem::NewerKind { wanted, loaded } => write!(
                f,
                "node '{node}' was made with version {wanted} of '{kind}', but version {loaded} is loaded; update Sabi \
                 or its node folder"
            ),
            Problem::UnknownInput { .. }
            | Problem::ParamWithoutMask { .. }
            | Problem::UnknownOutput { .. }
            | Problem::Mistyped { .. }
            | Problem::MissingInput { .. } => self.about_link(f),
            Problem::UnknownParam { param, .. } => {
                write!(
                    f,
                    "node '{node}' ({kind}) has no parameter '{param}'; it is kept and ignored"
                )
            }
            Problem::BadValue { param, expected, found } => {
                write!(
                    f,
                    "parameter '{param}' of node '{node}' ({kind}) takes {expected}, not {found}"
                )
            }
            Problem::BadFile(fault) => write!(f, "parameter '{}' of node '{node}' ({kind}): {fault}", fault.param),
            Problem::NoSuchResult {
                output: Some(output),
                known,
            } if !known.is_empty() => {
                let known = known.join(", ");
                write!(f, "node '{node}' ({kind}) has no result '{output}'; it gives {known}")
            }
            Problem::NoSuchResult { .. } => write!(f, "node '{node}' ({kind}) gives no result to look at"),
        }
    }
}

impl Sentence<'_> {
    /// Writes the sentence of a problem of an input.
    fn about_link(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Sentence { node, kind, problem } = self;
        match problem {
            Problem::UnknownInput { port, .. } => write!(f, "node '{node}' ({kind}) has no input '{port}'"),
            Problem::ParamWithoutMask { param } => write!(
                f,
                "parameter '{param}' of node '{node}' ({kind}) is not read for each place, so no mask can multiply it; \
                 remove the link"
            ),
            Problem::UnknownOutput { port, from, output, .. } => {
                write!(
                    f,
                    "input '{port}' of node '{node}' asks '{from}' for '{output}', which it does not give"
                )
            }
            Problem::Mistyped {
                port,
                expected,
                from,
                found,
            } => write!(
                f,
                "input '{port}' of node '{node}' takes a {expected}, but '{from}' gives a {found}; connect a {expected}"
            ),
            Problem::MissingInput { port, expected } => {
                write!(
                    f,
                    "input '{port}' of node '{node}' ({kind}) must be connected to a {expected}"
                )
            }
            // The other problems do not concern inputs.
            _ => Ok(()),
        }
    }
}

impl Problem {
    /// Input or parameter with the problem.
    pub fn member(&self) -> Option<&str> {
        match self {
            Problem::UnknownInput { port, .. }
            | Problem::UnknownOutput { port, .. }
            | Problem::Mistyped { port, .. }
            | Problem::MissingInput { port, .. } => Some(port),
            Problem::UnknownParam { param, .. }
            | Problem::BadValue { param, .. }
            | Problem::ParamWithoutMask { param } => Some(param),
            Problem::BadFile(fault) => Some(&fault.param),
            Problem::UnknownKind { .. } | Problem::NewerKind { .. } | Problem::NoSuchResult { .. } => None,
        }
    }
}

impl std::error::Error for PlanError {}

impl PlanError {
    /// Returns true if the graph can be used in spite of the problem: the value has no effect and stays in the file.
    pub fn is_warning(&self) -> bool {
        matches!(self.problem, Problem::UnknownParam { .. })
    }
}

fn did_you_mean(f: &mut fmt::Formatter<'_>, nearest: &Option<String>) -> fmt::Result {
    match nearest {
        Some(nearest) => write!(f, "; did you mean '{nearest}'?"),
        None => Ok(()),
    }
}
