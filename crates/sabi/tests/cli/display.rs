//! A screen in memory, and hands on its mouse and keyboard.

use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use tempfile::TempDir;

const INSTALL: &str =
    "this test needs a display in memory: apt-get install xvfb xdotool libxkbcommon-x11-0 libx11-xcb1";
/// Longer than anything takes on a busy machine; only a mistake comes near.
const PATIENCE: Duration = Duration::from_secs(120);
const SIZE: [u32; 2] = [1600, 900];

/// A display of its own.
pub(crate) struct Display {
    server: Child,
    name: String,
    folder: TempDir,
}

/// What is on the screen.
pub(crate) struct Screen {
    pub(crate) size: [usize; 2],
    /// Red, green and blue, row by row.
    pub(crate) pixels: Vec<[u8; 3]>,
}

impl Display {
    pub(crate) fn new() -> Display {
        let folder = tempfile::tempdir().unwrap();
        let screen = format!("{}x{}x24", SIZE[0], SIZE[1]);
        // The server looks for a free number itself, and writes it where it is told to. Without `-noreset` it would begin
        // anew whenever whoever looks for the window leaves, and take along a program that has just come.
        let mut server = Command::new("Xvfb")
            .args([
                "-noreset",
                "-displayfd",
                "1",
                "-screen",
                "0",
                &screen,
                "-nolisten",
                "tcp",
                "-fbdir",
            ])
            .arg(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect(INSTALL);
        let mut number = String::new();
        let output = server.stdout.take().expect("a pipe");
        std::io::BufRead::read_line(&mut std::io::BufReader::new(output), &mut number).expect(INSTALL);
        Display {
            server,
            name: format!(":{}", number.trim()),
            folder,
        }
    }

    /// Has a program draw here.
    pub(crate) fn on(&self, command: &mut Command) {
        command.env("DISPLAY", &self.name).env_remove("WAYLAND_DISPLAY");
    }

    /// Moves the mouse and presses keys, as `xdotool` is told to; says what it says.
    pub(crate) fn hands(&self, words: &[&str]) -> String {
        let output = Command::new("xdotool")
            .args(words)
            .env("DISPLAY", &self.name)
            .output()
            .expect(INSTALL);
        // What is done is seen a little later.
        sleep(Duration::from_millis(250));
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }

    pub(crate) fn key(&self, key: &str) {
        self.hands(&["key", key]);
    }

    pub(crate) fn point(&self, [x, y]: [i32; 2]) {
        self.hands(&["mousemove", &x.to_string(), &y.to_string()]);
    }

    /// Drags with the left button, by way of the middle.
    pub(crate) fn drag(&self, from: [i32; 2], to: [i32; 2]) {
        self.point(from);
        self.hands(&["mousedown", "1"]);
        self.point([(from[0] + to[0]) / 2, (from[1] + to[1]) / 2]);
        self.point(to);
        self.hands(&["mouseup", "1"]);
    }

    /// Waits for the window and gives it the keys, since there is nobody else who would.
    pub(crate) fn take_window(&self) {
        self.until("a window", || {
            let found = self.hands(&["search", "--name", "Sabi$"]);
            let Some(window) = found.lines().next_back() else {
                return false;
            };
            self.hands(&["windowfocus", window]);
            self.hands(&["getwindowfocus"]) == window
        });
    }

    pub(crate) fn until(&self, what: &str, mut is_so: impl FnMut() -> bool) {
        let began = Instant::now();
        while !is_so() {
            assert!(began.elapsed() < PATIENCE, "{what} did not come");
            sleep(Duration::from_millis(200));
        }
    }

    /// What is on the screen, in the form of the X window dump that the server keeps in memory.
    pub(crate) fn screen(&self) -> Screen {
        let file: PathBuf = self.folder.path().join("Xvfb_screen0");
        let bytes = fs::read(file).expect("the server's memory");
        let word = |at: usize| u32::from_be_bytes(bytes[4 * at..4 * at + 4].try_into().unwrap()) as usize;
        let [header, width, height, line, colors] = [0, 4, 5, 12, 19].map(word);
        let first = header + 12 * colors;
        let rows = (0..height).map(|row| &bytes[first + row * line..first + row * line + 4 * width]);
        // Four bytes a pixel, blue first.
        let pixels = rows.flat_map(|row| row.chunks_exact(4).map(|pixel| [pixel[2], pixel[1], pixel[0]]));
        Screen {
            size: [width, height],
            pixels: pixels.collect(),
        }
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

impl Screen {
    /// How many colors there are in a part of the screen: `[left, top, right, bottom]`.
    pub(crate) fn colors(&self, [left, top, right, bottom]: [usize; 4]) -> usize {
        let rows = (top..bottom).flat_map(|row| &self.pixels[row * self.size[0] + left..row * self.size[0] + right]);
        rows.collect::<std::collections::BTreeSet<_>>().len()
    }
}
