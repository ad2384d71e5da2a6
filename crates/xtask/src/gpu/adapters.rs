//! The adapters of this machine, as `sabi doctor` lists them.

use std::fmt;
use std::process::Stdio;

use serde_json::Value;

use super::pack::{Pack, ProgramRole};
use xtask::project::{Project, TaskError, output_of};

/// An adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Adapter {
    /// Name as its driver gives it.
    pub(super) name: String,
    /// `discrete`, `integrated` or `cpu`.
    pub(super) kind: String,
    /// Driver and its version.
    pub(super) driver: String,
    /// Interface that it is reached by, such as `vulkan`.
    pub(super) backend: String,
}

impl fmt::Display for Adapter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Adapter {
            name,
            kind,
            driver,
            backend,
        } = self;
        write!(f, "{name} ({kind}, {backend}, {driver})")
    }
}

impl Adapter {
    /// Lists all adapters, the one that a user gets by default first.
    pub(super) fn find_all(project: &Project, pack: &Pack) -> Result<Vec<Adapter>, TaskError> {
        let Some((_, sabi)) = pack.of(ProgramRole::Sabi).next() else {
            return Err(TaskError::failed(
                "The pack has no sabi, which lists the adapters: pack it again.",
            ));
        };
        let mut doctor = project.command(sabi)?;
        let output = output_of(doctor.args(["doctor", "--json"]).stderr(Stdio::inherit()))?;
        let adapters = listed(&output.stdout)?;
        if adapters.is_empty() {
            return Err(TaskError::new(
                4,
                "This machine has no adapter: install a Vulkan driver.",
            ));
        }
        Ok(adapters)
    }

    /// Returns true if it is a software driver that runs on the CPU.
    pub(super) fn is_software(&self) -> bool {
        self.kind == "cpu"
    }

    /// Name of the folder of its results.
    pub(super) fn folder_name(&self) -> String {
        let letters = self.name.chars().map(|c| {
            if c.is_ascii_alphanumeric() {
                c.to_ascii_lowercase()
            } else {
                '-'
            }
        });
        let words: String = letters.collect();
        words
            .split('-')
            .filter(|word| !word.is_empty())
            .collect::<Vec<_>>()
            .join("-")
    }
}

fn listed(json: &[u8]) -> Result<Vec<Adapter>, TaskError> {
    let found: Value = serde_json::from_slice(json)
        .map_err(|error| TaskError::failed(format!("`sabi doctor --json` did not write JSON: {error}.")))?;
    let text = |adapter: &Value, key: &str| -> Result<String, TaskError> {
        let text = adapter[key].as_str().map(str::to_owned);
        text.ok_or_else(|| TaskError::failed(format!("`sabi doctor --json` says nothing of an adapter's {key}.")))
    };
    let read = |adapter: &Value| {
        Ok(Adapter {
            name: text(adapter, "name")?,
            kind: text(adapter, "kind")?,
            driver: text(adapter, "driver")?,
            backend: text(adapter, "backend")?,
        })
    };
    found["adapters"].as_array().into_iter().flatten().map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adapters_are_read_from_the_output_of_the_doctor() {
        let json = br#"{ "adapters": [{ "name": "llvmpipe (LLVM 15.0.6, 256 bits)", "kind": "cpu", "driver": "llvmpipe Mesa 22",
            "backend": "vulkan" }] }"#;
        let adapters = listed(json).unwrap();
        assert!(adapters[0].is_software());
        assert_eq!(adapters[0].folder_name(), "llvmpipe-llvm-15-0-6-256-bits");
        assert_eq!(
            adapters[0].to_string(),
            "llvmpipe (LLVM 15.0.6, 256 bits) (cpu, vulkan, llvmpipe Mesa 22)"
        );
    }

    #[test]
    fn an_adapter_without_a_kind_is_an_error() {
        let stop = listed(br#"{ "adapters": [{ "name": "a" }] }"#).unwrap_err();
        assert_eq!(stop.sentence, "`sabi doctor --json` says nothing of an adapter's kind.");
    }
}
