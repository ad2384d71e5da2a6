//! Separate folder for each test, with models and graphs, in which the binary is run.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

use tempfile::TempDir;

/// A mask from noise; `amount` is its knob.
pub(crate) const CLOUDS: &str = r#"    "clouds": { "kind": "noise/simplex" },
    "out": { "kind": "output/mask", "inputs": { "source": "clouds" } }"#;

/// A material whose color and roughness vary.
pub(crate) const RUST: &str = r##"    "base": { "kind": "source/material", "params": { "color": "#3c5a6e" } },
    "clouds": { "kind": "noise/simplex" },
    "out": { "kind": "output/material", "inputs": { "material": "rust" } },
    "rust": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "clouds" },
      "params": { "color": "#6b3a1e", "height": 0.01 } }"##;

/// Returns a graph file with these nodes, which begin in line 8 of the file.
pub(crate) fn graph(nodes: &str) -> String {
    format!(
        r#"{{
  "format": "sabi",
  "version": 1,
  "name": "test",
  "exposed": {{ "amount": {{ "to": ["clouds.gain"], "range": [0, 1] }}, "look": {{ "to": ["clouds.mode"] }} }},
  "variants": {{ "heavy": {{ "amount": 0.9 }} }},
  "nodes": {{
{nodes}
  }}
}}
"#
    )
}

/// A folder with `cube.glb`, `sphere.glb`, `clouds.sabi` and `rust.sabi`.
pub(crate) struct CliFolder {
    folder: TempDir,
}

/// Outcome of a run.
#[derive(Debug)]
pub(crate) struct RunOutput {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl CliFolder {
    pub(crate) fn new() -> CliFolder {
        let place = CliFolder {
            folder: tempfile::tempdir().unwrap(),
        };
        let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/meshes");
        for model in ["cube.glb", "sphere.glb"] {
            fs::copy(models.join(model), place.path(model)).unwrap();
        }
        place.write("clouds.sabi", graph(CLOUDS));
        place.write("rust.sabi", graph(RUST));
        place
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Returns the names of all files in a folder, including hidden ones, except the manifest that each bake leaves.
    pub(crate) fn listing(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).unwrap_or_else(|error| panic!("{folder}: {error}"));
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.retain(|name| name != ".sabi" || !self.path(folder).join(".sabi/bakes.json").is_file());
        names.sort();
        names
    }

    /// Returns the binary in this folder, without the user's own settings and caches.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sabi"));
        command
            .args(arguments)
            .current_dir(self.folder.path())
            .env("XDG_RUNTIME_DIR", self.folder.path())
            .env("SABI_CACHE_DIR", self.path(".cache"))
            .env("SABI_NODES", self.path(".nodes"))
            .env_remove("RUST_BACKTRACE")
            .env_remove("SABI_LOG")
            // Without this, slow machines would print progress lines that fast ones do not.
            .env("SABI_PROGRESS", "none")
            // No test opens a window on the user's screen.
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .stdin(Stdio::null());
        command
    }

    pub(crate) fn sabi(&self, arguments: &[&str]) -> RunOutput {
        done(self.command(arguments).output().unwrap())
    }

    /// Runs the binary with these bytes on standard input.
    pub(crate) fn sabi_reading(&self, arguments: &[&str], input: impl AsRef<[u8]>) -> RunOutput {
        let mut command = self.command(arguments);
        command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        // A program that refuses its input closes it early.
        let _ = child.stdin.take().unwrap().write_all(input.as_ref());
        done(child.wait_with_output().unwrap())
    }

    /// `sabi bake` at size 64 on the software adapter.
    pub(crate) fn bake(&self, graph: &str, model: &str, more: &[&str]) -> RunOutput {
        software_adapter();
        let mut arguments = vec!["bake", graph, "--mesh", model, "--adapter", "cpu"];
        for (option, value) in [("--size", "64"), ("-o", "out")] {
            if !more.contains(&option) {
                arguments.extend([option, value]);
            }
        }
        arguments.extend(more);
        // With this setting, the software driver compiles kernels in half the time, and small maps are computed as fast.
        done(self.command(&arguments).env("GALLIVM_PERF", "nopt").output().unwrap())
    }

    /// Runs a bake that must be refused with this code and this sentence, and must not write files.
    pub(crate) fn refuses(&self, graph: &str, model: &str, more: &[&str], code: i32, words: &str) {
        let done = self.bake(graph, model, more);
        assert_eq!(
            done.stderr.trim_end(),
            format!("error: {words}"),
            "{graph} {model} {more:?}"
        );
        assert_eq!(done.code, Some(code), "{words}");
        assert_eq!(done.stdout, "", "{words}");
        assert!(!self.path("out").exists(), "{words}");
    }
}

pub(crate) fn done(output: Output) -> RunOutput {
    RunOutput {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

impl RunOutput {
    /// Checks that the run succeeded.
    #[track_caller]
    pub(crate) fn good(self) -> RunOutput {
        assert_eq!(self.code, Some(0), "{self:?}");
        self
    }

    #[track_caller]
    pub(crate) fn fails(self, code: i32) -> RunOutput {
        assert_eq!(self.code, Some(code), "{self:?}");
        self
    }
}

/// Fails with the install command if there is no software driver.
pub(crate) fn software_adapter() {
    static THERE: OnceLock<bool> = OnceLock::new();
    let there = THERE.get_or_init(|| {
        let doctor = Command::new(env!("CARGO_BIN_EXE_sabi"))
            .args(["doctor", "--json"])
            .output();
        String::from_utf8(doctor.unwrap().stdout)
            .unwrap()
            .contains(r#""kind": "cpu""#)
    });
    assert!(
        there,
        "these tests need a Vulkan software driver; on Debian or Ubuntu run: sudo apt-get install -y \
         mesa-vulkan-drivers libvulkan1"
    );
}
