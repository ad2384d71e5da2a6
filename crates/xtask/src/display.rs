//! What a real window needs where there is no screen: a display in memory, and hands for it.

use crate::packages::{find_library, install, program};
use crate::place::{Place, Stop};

/// Debian's names.
const PACKAGES: [&str; 4] = ["xvfb", "xdotool", "libxkbcommon-x11-0", "libx11-xcb1"];
const PROGRAMS: [&str; 2] = ["Xvfb", "xdotool"];
const LIBRARIES: [&str; 2] = ["libxkbcommon-x11.so.0", "libX11-xcb.so.1"];
/// Where there is no apt.
const BY_HAND: &str = "Install Xvfb and xdotool with your system's package manager, then run this again: on Fedora `sudo dnf \
    install xorg-x11-server-Xvfb xdotool libxkbcommon-x11`, on Arch `sudo pacman -S xorg-server-xvfb xdotool libxkbcommon-x11`.";

/// Makes sure that the window can be tested, installing what it needs where that can be done.
pub(crate) fn ensure(place: &Place) -> Result<(), Stop> {
    if !cfg!(target_os = "linux") {
        // Elsewhere the window is tested without a screen only.
        return Ok(());
    }
    let Some(missing) = missing() else { return Ok(()) };
    let sentence = format!("The test of the real window needs {missing}, which was not found");
    install(place, &sentence, &PACKAGES, "what a window is tested with", BY_HAND)?;
    match self::missing() {
        None => Ok(()),
        Some(still) => Err(Stop::new(
            1,
            format!(
                "{still} was not found, although {} were installed.",
                PACKAGES.join(", ")
            ),
        )),
    }
}

/// The first thing that is not there.
fn missing() -> Option<&'static str> {
    let program = PROGRAMS.into_iter().find(|name| program(name).is_none());
    program.or_else(|| LIBRARIES.into_iter().find(|name| find_library(name).is_none()))
}
