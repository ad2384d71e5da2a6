//! `cargo xtask soak`: hours of input at random in the real window, whose memory must stay bounded.

mod hands;

use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use hands::{Hands, SIZE};
use xtask::display;
use xtask::project::{Project, TaskError, create_folder, finish, not_written};
use xtask::vulkan::{self, Driver};

const GRAPH: &str = "graphs/examples/army-paint.sabi";
const MODEL: &str = "assets/meshes/crate.glb";
const MINUTES: u64 = 120;
/// Memory that counts as a leak, MiB: the window keeps results of up to 4 GiB; models, pictures and the program come on
/// top.
const MOST_MIB: f64 = 6144.0;
/// Time that a window may take to open, and an action to have an effect.
const OPENING: Duration = Duration::from_secs(120);
const BETWEEN: Duration = Duration::from_millis(150);

/// A running program with its window, ended when it is dropped.
struct RunningProgram(Child);

impl Drop for RunningProgram {
    fn drop(&mut self) {
        // Both fail only where the process has ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Soaks the window, for as many minutes as the first argument says.
pub(crate) fn run(project: &Project, arguments: &[String]) -> Result<(), TaskError> {
    let minutes = match arguments.first().map(|word| word.parse::<u64>()) {
        None => MINUTES,
        Some(Ok(minutes)) if minutes > 0 => minutes,
        Some(_) => {
            return Err(TaskError::new(
                2,
                "`cargo xtask soak` takes a number of minutes, such as 120.",
            ));
        }
    };
    if !cfg!(target_os = "linux") {
        return Err(TaskError::failed(
            "The soak needs Xvfb and xdotool, so it runs on Linux only.",
        ));
    }
    vulkan::ensure(project, Driver::Any)?;
    display::ensure(project)?;
    let program = program(project, arguments.get(1))?;
    let folder = project.target.join("soak");
    create_folder(&folder)?;
    let graph = folder.join("soak.sabi");
    fs::copy(project.root.join(GRAPH), &graph).map_err(|error| not_written(&graph, &error))?;
    let (_server, screen) = server()?;
    let soak = Soak {
        project,
        program,
        folder,
        graph,
        screen,
    };
    soak.run(Duration::from_secs(60 * minutes))
}

/// The program to soak: a given one, or the release build, built where it is missing.
fn program(project: &Project, given: Option<&String>) -> Result<PathBuf, TaskError> {
    if let Some(given) = given {
        return Ok(PathBuf::from(given));
    }
    let build = ["build", "--release", "--locked", "--package", "sabi"];
    finish(project.cargo(&build)?, "Building sabi")?;
    Ok(project.sabi("release"))
}

/// Starts a display in memory. The server chooses a free number and writes it to its standard output.
fn server() -> Result<(RunningProgram, String), TaskError> {
    let size = format!("{}x{}x24", SIZE[0], SIZE[1]);
    let mut server = Command::new("Xvfb")
        .args(["-noreset", "-displayfd", "1", "-screen", "0", &size, "-nolisten", "tcp"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|error| TaskError::failed(format!("Xvfb cannot be started: {error}.")))?;
    let mut number = String::new();
    if let Some(output) = server.stdout.take() {
        BufReader::new(output)
            .read_line(&mut number)
            .map_err(|error| TaskError::failed(format!("Xvfb did not name its display: {error}.")))?;
    }
    Ok((RunningProgram(server), format!(":{}", number.trim())))
}

/// A soak: its program, its folder, its graph and its display.
struct Soak<'a> {
    project: &'a Project,
    program: PathBuf,
    /// Home of the program, with its log.
    folder: PathBuf,
    graph: PathBuf,
    screen: String,
}

impl Soak<'_> {
    /// Performs actions until the time is over, and prints a row each minute.
    fn run(&self, length: Duration) -> Result<(), TaskError> {
        let began = Instant::now();
        let mut hands = Hands::new(self.screen.clone(), 1);
        let mut window = self.open(&hands)?;
        let (mut actions, mut opened, mut next_row) = (0_u64, 1_u64, Duration::ZERO);
        // Memory at each row, MiB.
        let mut samples: Vec<f64> = Vec::new();
        eprintln!("| minutes | actions | windows | memory |\n|---|---|---|---|");
        while began.elapsed() < length {
            if let Some(status) = window.0.try_wait().ok().flatten() {
                if !status.success() {
                    return Err(self.ended(&format!("The program ended after {actions} actions: {status}.")));
                }
                window = self.open(&hands)?;
                opened += 1;
            }
            if began.elapsed() >= next_row {
                let minutes = began.elapsed().as_secs_f64() / 60.0;
                let mib = resident_mib(&window.0).unwrap_or(f64::NAN);
                eprintln!("| {minutes:.0} | {actions} | {opened} | {mib:.0} MiB |");
                samples.push(mib);
                next_row += Duration::from_secs(60);
                // A dialog may have taken the focus.
                hands.take_window();
            }
            hands.act()?;
            actions += 1;
            sleep(BETWEEN);
        }
        self.judge(&samples)
    }

    /// Opens the window and waits for it.
    fn open(&self, hands: &Hands) -> Result<RunningProgram, TaskError> {
        let log = self.folder.join("log.txt");
        let output = File::create(&log).map_err(|error| not_written(&log, &error))?;
        let mut command = self.project.command(&self.program)?;
        command
            .arg(&self.graph)
            .arg("--mesh")
            .arg(self.project.root.join(MODEL))
            .env("DISPLAY", &self.screen)
            .env_remove("WAYLAND_DISPLAY")
            .env("HOME", &self.folder)
            .env("XDG_CONFIG_HOME", self.folder.join("config"))
            .env("XDG_DATA_HOME", self.folder.join("data"))
            .env("XDG_CACHE_HOME", self.folder.join("cache"))
            .stdout(Stdio::null())
            .stderr(output);
        let child = command
            .spawn()
            .map_err(|error| TaskError::failed(format!("{} cannot be started: {error}.", self.program.display())))?;
        let window = RunningProgram(child);
        let began = Instant::now();
        while !hands.take_window() {
            if began.elapsed() > OPENING {
                return Err(self.ended("The window did not open."));
            }
            sleep(Duration::from_millis(500));
        }
        Ok(window)
    }

    /// The failure of a soak, with what the program wrote last.
    fn ended(&self, what: &str) -> TaskError {
        let log = fs::read_to_string(self.folder.join("log.txt")).unwrap_or_else(|error| error.to_string());
        let lines: Vec<&str> = log.lines().collect();
        let last = lines[lines.len().saturating_sub(20)..].join("\n");
        TaskError::failed(format!("{what} Its last lines:\n{last}"))
    }

    /// Prints the most memory in the first quarter of the time and in the rest, and compares both with the bound.
    fn judge(&self, samples: &[f64]) -> Result<(), TaskError> {
        let highest = |part: &[f64]| part.iter().copied().fold(0.0, f64::max);
        let quarter = samples.len().div_ceil(4); // At least one.
        let (early, late) = (highest(&samples[..quarter]), highest(&samples[quarter..]));
        eprintln!("\nMost memory in the first quarter {early:.0} MiB, later {late:.0} MiB.");
        if late.max(early) > MOST_MIB {
            return Err(self.ended(&format!("The window takes more than {MOST_MIB:.0} MiB.")));
        }
        Ok(())
    }
}

/// Memory that a process takes, MiB; `None` where the system does not say.
fn resident_mib(process: &Child) -> Option<f64> {
    let path = Path::new("/proc").join(process.id().to_string()).join("status");
    let status = fs::read_to_string(path).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kib / 1024.0)
}
