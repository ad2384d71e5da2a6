//! Why a document cannot be flattened.

/// Why a document cannot be flattened.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FlattenError {
    /// The variant asked for is not there.
    #[error("there is no variant {name}{hint}; this graph has {known}")]
    NoSuchVariant {
        /// The name, quoted.
        name: String,
        /// The nearest, as a question.
        hint: String,
        /// All of them, quoted.
        known: String,
    },
    /// `--set` names nothing.
    #[error("nothing is called {name}{hint}; set an exposed knob ({known}) or a node's parameter as node.param")]
    NoSuchKnob {
        /// The name, quoted.
        name: String,
        /// The nearest, as a question.
        hint: String,
        /// All exposed knobs, quoted.
        known: String,
    },
    /// A number outside a knob's range.
    #[error("{knob} is {value}, but goes from {low} to {high}; choose a value in that range")]
    OutOfRange {
        /// The knob, quoted.
        knob: String,
        /// The number asked for.
        value: String,
        /// Lower end.
        low: String,
        /// Upper end.
        high: String,
    },
    /// A knob with a range was given something else than numbers.
    #[error("{knob} takes a number from {low} to {high}, not {value}")]
    NotANumber {
        /// The knob, quoted.
        knob: String,
        /// Lower end.
        low: String,
        /// Upper end.
        high: String,
        /// What it was given.
        value: String,
    },
}
