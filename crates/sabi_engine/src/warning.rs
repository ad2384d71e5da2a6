//! Warnings: probable mistakes, with remedies.

use std::fmt;

use serde::{Serialize, Serializer};

use crate::error::shorten;
use crate::remedy::{Remedy, advised};

/// Sentence on something that is probably not intended and stops nothing, with its remedies.
///
/// Its text is the sentence followed by the remedies, without flags and buttons.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Node it is about, if it is about one; inside groups `instance/inner`.
    pub node: Option<String>,
    /// Description of the problem, as a sentence.
    pub sentence: String,
    /// Remedies for the user, best first.
    pub remedies: Vec<Remedy>,
}

impl Warning {
    /// A warning with remedies.
    pub fn new(sentence: impl Into<String>, remedies: impl IntoIterator<Item = Remedy>) -> Warning {
        let mut sentence = sentence.into();
        shorten(&mut sentence);
        Warning {
            node: None,
            sentence,
            remedies: remedies.into_iter().collect(),
        }
    }
}

impl From<String> for Warning {
    fn from(sentence: String) -> Warning {
        Warning::new(sentence, [])
    }
}

impl From<&str> for Warning {
    fn from(sentence: &str) -> Warning {
        Warning::new(sentence, [])
    }
}

impl From<&Warning> for Warning {
    fn from(warning: &Warning) -> Warning {
        warning.clone()
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&advised(&self.sentence, &self.remedies))
    }
}

impl Serialize for Warning {
    /// Written as its text.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
