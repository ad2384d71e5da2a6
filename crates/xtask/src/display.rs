//! Requirements of tests of a real window without a screen: a virtual display, and a tool that simulates input.

use crate::packages::{Requirement, find_library, program};
use crate::project::{Project, TaskError};

const WINDOW_TESTS: Requirement = Requirement {
    what: "the tools that test a window",
    packages: &["xvfb", "xdotool", "libxkbcommon-x11-0", "libx11-xcb1"],
    by_hand: "Install Xvfb and xdotool with your system's package manager, then run this again: on Fedora `sudo dnf install \
              xorg-x11-server-Xvfb xdotool libxkbcommon-x11`, on Arch `sudo pacman -S xorg-server-xvfb xdotool \
              libxkbcommon-x11`.",
};
const PROGRAMS: [&str; 2] = ["Xvfb", "xdotool"];
const LIBRARIES: [&str; 2] = ["libxkbcommon-x11.so.0", "libX11-xcb.so.1"];

/// Makes sure that the window can be tested, and installs the missing packages where that is possible.
pub fn ensure(project: &Project) -> Result<(), TaskError> {
    if !cfg!(target_os = "linux") {
        // Elsewhere the window is tested without a screen only.
        return Ok(());
    }
    WINDOW_TESTS.ensure(project, || {
        missing().map(|name| format!("The test of the real window needs {name}, which was not found"))
    })
}

/// Returns the first program or library that is missing.
fn missing() -> Option<&'static str> {
    let program = PROGRAMS.into_iter().find(|name| program(name).is_none());
    program.or_else(|| LIBRARIES.into_iter().find(|name| find_library(name).is_none()))
}
