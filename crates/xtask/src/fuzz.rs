//! `cargo xtask fuzz`: every fuzz target for a while, with its seeds, its dictionary and limits of time and memory.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

use xtask::packages::{Requirement, program};
use xtask::project::{Project, TaskError, create_folder, finish, output_of, write_file};

/// Seconds of each target.
const SECONDS: u64 = 60;
/// Limits of one input: seconds, and MiB of the process and of one allocation.
const LIMITS: [&str; 3] = ["-timeout=20", "-rss_limit_mb=2048", "-malloc_limit_mb=1024"];
/// Folder of cargo-fuzz, of what it builds and of the logs, in the target folder.
const FOLDER: &str = "fuzzing";
/// Seeds that are files of the project itself.
const OWN_SEEDS: [(&str, &str); 3] = [
    ("graph", "graphs"),
    ("node", "shaders/nodes"),
    ("linked", "shaders/nodes"),
];
/// Targets that share the dictionary of another one.
const SHARED_DICTIONARIES: [(&str, &str); 4] = [
    ("groups", "graph"),
    ("linked", "node"),
    ("copy", "gltf"),
    ("paths", "gltf"),
];

const COMPILER: Requirement = Requirement {
    what: "the C++ compiler",
    packages: &["g++"],
    by_hand: "libFuzzer is compiled with the targets. Install a C++ compiler, then run this again.",
};

/// Request on the command line.
#[derive(Debug, PartialEq, Eq)]
struct FuzzRequest {
    /// The only target; all of them otherwise.
    target: Option<String>,
    seconds: u64,
}

impl FuzzRequest {
    fn read(arguments: &[String]) -> Result<FuzzRequest, TaskError> {
        let mut request = FuzzRequest {
            target: None,
            seconds: SECONDS,
        };
        let mut rest = arguments.iter();
        while let Some(word) = rest.next() {
            if word == "--seconds" {
                let number = rest.next().and_then(|number| number.parse().ok());
                request.seconds = number.filter(|seconds| *seconds > 0).ok_or_else(refused)?;
            } else if word.starts_with('-') || request.target.is_some() {
                return Err(refused());
            } else {
                request.target = Some(word.clone());
            }
        }
        Ok(request)
    }
}

fn refused() -> TaskError {
    TaskError::new(
        2,
        "`cargo xtask fuzz` takes the name of a target, and `--seconds N` with a number above 0.",
    )
}

/// Result of a target.
struct Ran {
    target: String,
    /// Inputs that were tried; `None` where the target ended before it counted them.
    inputs: Option<u64>,
    /// Files with inputs that make it fail.
    found: Vec<PathBuf>,
}

/// Builds and runs the targets.
pub(crate) fn run(project: &Project, arguments: &[String]) -> Result<(), TaskError> {
    let request = FuzzRequest::read(arguments)?;
    let targets = chosen(targets(project)?, request.target.as_deref())?;
    COMPILER.ensure(project, missing_compiler)?;
    let fuzzer = Fuzzer {
        project,
        program: installed(project)?,
    };
    let mut build = fuzzer.command("build")?;
    build.args(&request.target);
    finish(build, "Building the fuzz targets")?;
    let mut all = Vec::new();
    for target in targets {
        eprintln!("{target}: {} seconds", request.seconds);
        let ran = fuzzer.run(&target, request.seconds)?;
        eprintln!("{}", sentence(&ran));
        all.push(ran);
    }
    let found: Vec<String> = all.iter().filter(|ran| !ran.found.is_empty()).map(sentence).collect();
    if found.is_empty() {
        return Ok(());
    }
    Err(TaskError::failed(format!(
        "{}\nCut each down with `cargo fuzz tmin --sanitizer none TARGET FILE`, mend it, and keep it as a named test.",
        found.join("\n")
    )))
}

/// Names of all targets, sorted.
fn targets(project: &Project) -> Result<Vec<String>, TaskError> {
    let folder = project.root.join("fuzz/fuzz_targets");
    let unread = |error| TaskError::failed(format!("{} cannot be listed: {error}.", folder.display()));
    let entries = fs::read_dir(&folder).map_err(unread)?;
    let stems = entries.filter_map(|entry| Some(entry.ok()?.path().file_stem()?.to_str()?.to_owned()));
    let mut targets: Vec<String> = stems.collect();
    targets.sort();
    Ok(targets)
}

fn chosen(targets: Vec<String>, name: Option<&str>) -> Result<Vec<String>, TaskError> {
    match name {
        None => Ok(targets),
        Some(name) if targets.iter().any(|target| target == name) => Ok(vec![name.to_owned()]),
        Some(name) => Err(TaskError::new(
            2,
            format!("There is no fuzz target `{name}`. These exist: {}.", targets.join(", ")),
        )),
    }
}

fn missing_compiler() -> Option<String> {
    let has_own = std::env::var_os("CXX").is_some();
    let is_there = has_own
        || ["c++", "g++", "clang++"]
            .into_iter()
            .any(|name| program(name).is_some());
    (!is_there).then(|| "No C++ compiler was found".to_owned())
}

/// Finds cargo-fuzz, and installs it into the target folder where it is missing.
fn installed(project: &Project) -> Result<PathBuf, TaskError> {
    let name = format!("cargo-fuzz{}", std::env::consts::EXE_SUFFIX);
    let folder = project.target.join(FOLDER);
    let own = folder.join("bin").join(&name);
    if let Some(known) = program(&name).or_else(|| own.is_file().then(|| own.clone())) {
        return Ok(known);
    }
    eprintln!("cargo-fuzz was not found. Installing it into {}.", folder.display());
    let mut install = project.cargo(&["install", "cargo-fuzz", "--locked", "--root"])?;
    install.arg(&folder);
    finish(install, "Installing cargo-fuzz").map_err(|stop| {
        let advice = "It comes from the registry of Rust: check the network, or run `cargo install cargo-fuzz` yourself, then this again.";
        TaskError::new(stop.code, format!("{} {advice}", stop.sentence))
    })?;
    Ok(own)
}

/// cargo-fuzz in the project.
struct Fuzzer<'p> {
    project: &'p Project,
    program: PathBuf,
}

impl Fuzzer<'_> {
    /// Creates a command of cargo-fuzz. Without a sanitizer it needs no nightly compiler.
    fn command(&self, task: &str) -> Result<Command, TaskError> {
        let mut command = self.project.command(&self.program)?;
        command.args([task, "--sanitizer", "none", "--target-dir"]);
        command.arg(self.project.target.join(FOLDER).join("build"));
        Ok(command)
    }

    fn run(&self, target: &str, seconds: u64) -> Result<Ran, TaskError> {
        let root = &self.project.root;
        let corpus = root.join("fuzz/corpus").join(target);
        let artifacts = root.join("fuzz/artifacts").join(target);
        create_folder(&corpus)?;
        let before = SystemTime::now();
        let mut command = self.command("run")?;
        command.arg(target).arg(&corpus).args(seeds(root, target));
        command.arg("--").args(LIMITS);
        command.arg(format!("-max_total_time={seconds}"));
        command.arg("-print_final_stats=1");
        if let Some(dictionary) = dictionary(root, target) {
            command.arg(format!("-dict={}", dictionary.display()));
        }
        let output = output_of(&mut command)?;
        let log = self.project.target.join(FOLDER).join(format!("{target}.log"));
        write_file(&log, &output.stderr)?;
        let ran = Ran {
            target: target.to_owned(),
            inputs: inputs_in(&String::from_utf8_lossy(&output.stderr)),
            found: written_since(&artifacts, before),
        };
        if output.status.success() || !ran.found.is_empty() {
            return Ok(ran);
        }
        Err(TaskError::failed(format!(
            "The fuzz target {target} could not be run; {} says why.",
            log.display()
        )))
    }
}

/// Folders of the seeds of a target.
fn seeds(root: &Path, target: &str) -> Vec<PathBuf> {
    let own = OWN_SEEDS.iter().filter(|(name, _)| *name == target);
    let own = own.map(|(_, folder)| root.join(folder));
    let kept = root.join("fuzz/seeds").join(target);
    own.chain([kept]).filter(|folder| folder.is_dir()).collect()
}

/// The dictionary of a target, where it has one.
fn dictionary(root: &Path, target: &str) -> Option<PathBuf> {
    let shared = SHARED_DICTIONARIES.iter().find(|(name, _)| *name == target);
    let name = shared.map_or(target, |(_, of)| of);
    let file = root.join(format!("fuzz/dictionaries/{name}.dict"));
    file.is_file().then_some(file)
}

/// Reads the number of inputs from the statistics that libFuzzer prints.
fn inputs_in(log: &str) -> Option<u64> {
    let line = log
        .lines()
        .rev()
        .find_map(|line| line.strip_prefix("stat::number_of_executed_units:"))?;
    line.trim().parse().ok()
}

/// Inputs that libFuzzer has written since a time, without those that were only slow.
fn written_since(folder: &Path, before: SystemTime) -> Vec<PathBuf> {
    // A target that has found nothing has no folder.
    let entries = fs::read_dir(folder).into_iter().flatten();
    let new = entries.filter_map(|entry| {
        let entry = entry.ok()?;
        let is_slow = entry.file_name().to_string_lossy().starts_with("slow-unit-");
        let is_new = entry
            .metadata()
            .and_then(|file| file.modified())
            .is_ok_and(|time| time >= before);
        (is_new && !is_slow).then(|| entry.path())
    });
    let mut files: Vec<PathBuf> = new.collect();
    files.sort();
    files
}

fn sentence(ran: &Ran) -> String {
    let inputs = ran
        .inputs
        .map_or_else(String::new, |inputs| format!(" in {inputs} inputs"));
    let files = ran.found.iter().map(|file| file.display().to_string());
    let files: Vec<String> = files.collect();
    match files[..] {
        [] => format!("{}: nothing was found{inputs}", ran.target),
        _ => format!("{}: found{inputs}: {}", ran.target, files.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(words: &[&str]) -> Result<FuzzRequest, TaskError> {
        FuzzRequest::read(&words.iter().map(ToString::to_string).collect::<Vec<_>>())
    }

    #[test]
    fn a_target_and_a_time_may_be_chosen() {
        let request = |target: Option<&str>, seconds| {
            let target = target.map(str::to_owned);
            Ok(FuzzRequest { target, seconds })
        };
        assert_eq!(read(&[]), request(None, 60));
        assert_eq!(read(&["node", "--seconds", "9"]), request(Some("node"), 9));
        for wrong in [&["--seconds"][..], &["--seconds", "0"], &["a", "b"], &["--all"]] {
            assert_eq!(read(wrong), Err(refused()), "{wrong:?}");
        }
    }

    #[test]
    fn an_unknown_target_is_refused_with_the_known_ones() {
        let targets = || vec!["graph".to_owned(), "node".to_owned()];
        assert_eq!(chosen(targets(), None), Ok(targets()));
        assert_eq!(chosen(targets(), Some("node")), Ok(vec!["node".to_owned()]));
        let told = "There is no fuzz target `nodes`. These exist: graph, node.";
        assert_eq!(chosen(targets(), Some("nodes")), Err(TaskError::new(2, told)));
    }

    #[test]
    fn every_target_has_seeds() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let project = Project {
            target: root.join("target"),
            root: root.clone(),
        };
        for target in targets(&project).unwrap() {
            assert!(!seeds(&root, &target).is_empty(), "{target}");
        }
        for (target, _) in SHARED_DICTIONARIES {
            assert!(dictionary(&root, target).is_some(), "{target}");
        }
    }

    #[test]
    fn the_result_of_a_target_is_one_line() {
        let log = "#12 DONE\nstat::number_of_executed_units: 4500\nstat::average_exec_per_sec:     75\n";
        let mut ran = Ran {
            target: "node".to_owned(),
            inputs: inputs_in(log),
            found: Vec::new(),
        };
        assert_eq!(sentence(&ran), "node: nothing was found in 4500 inputs");
        ran.found = vec![PathBuf::from("fuzz/artifacts/node/crash-1")];
        ran.inputs = inputs_in("killed");
        assert_eq!(sentence(&ran), "node: found: fuzz/artifacts/node/crash-1");
    }
}
