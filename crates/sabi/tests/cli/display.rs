//! A virtual display (Xvfb), and input by xdotool.

use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use tempfile::TempDir;

const INSTALL: &str =
    "this test needs a display in memory: apt-get install xvfb xdotool libxkbcommon-x11-0 libx11-xcb1";
/// Time limit of a wait: longer than any step takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);
const SIZE: [u32; 2] = [1600, 900];
/// Time without a change after which the screen counts as unchanged.
const STILL: Duration = Duration::from_secs(2);
/// Pause after each step of a drag.
const DRAG_STEP: Duration = Duration::from_millis(750);
/// Number of changed pixels that shows that a menu or a node appeared or disappeared: fewer than either has, and more than a caret has.
const CHANGED_PIXELS: usize = 8000;

/// Virtual display of one test.
pub(crate) struct Display {
    server: Child,
    name: String,
    folder: TempDir,
}

/// Screenshot.
pub(crate) struct Screenshot {
    pub(crate) size: [usize; 2],
    /// Red, green and blue of each pixel, row by row.
    pub(crate) pixels: Vec<[u8; 3]>,
}

impl Display {
    pub(crate) fn new() -> Display {
        let folder = tempfile::tempdir().unwrap();
        let screen = format!("{}x{}x24", SIZE[0], SIZE[1]);
        // The server chooses a free number and writes it to its standard output. Without `-noreset` it restarts when its last
        // client leaves, such as a search for the window, and closes the connections of clients that have just started.
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

    /// Makes a program use this display.
    pub(crate) fn on(&self, command: &mut Command) {
        command.env("DISPLAY", &self.name).env_remove("WAYLAND_DISPLAY");
    }

    /// Runs `xdotool` with these arguments and returns its output.
    pub(crate) fn hands(&self, words: &[&str]) -> String {
        let output = Command::new("xdotool")
            .args(words)
            .env("DISPLAY", &self.name)
            .output()
            .expect(INSTALL);
        // The window reacts a little later.
        sleep(Duration::from_millis(250));
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }

    pub(crate) fn key(&self, key: &str) {
        self.hands(&["key", key]);
    }

    pub(crate) fn point(&self, [x, y]: [i32; 2]) {
        self.hands(&["mousemove", &x.to_string(), &y.to_string()]);
    }

    /// Drags with the left button along a straight line, slowly: frames take long on a busy machine, and each step needs a frame.
    pub(crate) fn drag(&self, from: [i32; 2], to: [i32; 2]) {
        self.point(from);
        self.hands(&["mousedown", "1"]);
        for place in [[(from[0] + to[0]) / 2, (from[1] + to[1]) / 2], to] {
            sleep(DRAG_STEP);
            self.point(place);
        }
        sleep(DRAG_STEP);
        self.hands(&["mouseup", "1"]);
    }

    /// Waits for the window and gives it the keyboard focus, since the display has no window manager.
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

    /// Waits until a part of the screen has not changed for a while.
    pub(crate) fn until_still(&self, part: [usize; 4], what: &str) {
        self.until(what, || {
            let before = self.screen();
            sleep(STILL);
            self.screen().part(part).eq(before.part(part))
        });
    }

    /// Does an action and waits until a large part of the screen has changed.
    pub(crate) fn until_changed(&self, part: [usize; 4], what: &str, act: impl FnOnce()) {
        let before = self.screen();
        act();
        self.until(what, || {
            let now = self.screen();
            let pairs = now.part(part).zip(before.part(part));
            pairs.filter(|(now, before)| now != before).count() > CHANGED_PIXELS
        });
    }

    /// Takes a screenshot from the X window dump that the server keeps in a file.
    pub(crate) fn screen(&self) -> Screenshot {
        let file: PathBuf = self.folder.path().join("Xvfb_screen0");
        let bytes = fs::read(file).expect("the server's memory");
        let word = |at: usize| u32::from_be_bytes(bytes[4 * at..4 * at + 4].try_into().unwrap()) as usize;
        let [header, width, height, line, colors] = [0, 4, 5, 12, 19].map(word);
        let first = header + 12 * colors;
        let rows = (0..height).map(|row| &bytes[first + row * line..first + row * line + 4 * width]);
        // Four bytes per pixel, blue first.
        let pixels = rows.flat_map(|row| row.chunks_exact(4).map(|pixel| [pixel[2], pixel[1], pixel[0]]));
        Screenshot {
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

impl Screenshot {
    /// Number of colors in a part of the screen: `[left, top, right, bottom]`.
    pub(crate) fn colors(&self, part: [usize; 4]) -> usize {
        self.part(part).collect::<std::collections::BTreeSet<_>>().len()
    }

    fn part(&self, [left, top, right, bottom]: [usize; 4]) -> impl Iterator<Item = &[u8; 3]> {
        (top..bottom).flat_map(move |row| &self.pixels[row * self.size[0] + left..row * self.size[0] + right])
    }
}
