//! Tablets of the system, by `octotablet`: the tablet protocol of Wayland, and Windows Ink.

use std::panic::{AssertUnwindSafe, catch_unwind};

use octotablet::events::{Event, ToolEvent};
use octotablet::tool::{ButtonID, Tool, Type};
use octotablet::{Builder, Manager};

use super::{PenEvent, UNSUPPORTED};

/// Tablets of the system.
pub(super) struct Tablet {
    manager: Manager,
    /// Buttons of shafts in the order in which they were pressed first, so that each of them keeps its meaning.
    buttons: Vec<ButtonID>,
}

impl Tablet {
    /// Connects to the tablets behind the window of a frame. The error is a sentence; `None` where the frame has no
    /// window.
    pub(super) fn connect(frame: &eframe::Frame) -> Option<Result<Tablet, String>> {
        let window = frame.winit_window()?;
        #[cfg(all(unix, not(target_os = "macos")))]
        if let Err(why) = super::protocol::check() {
            return Some(Err(why));
        }
        let builder = Builder::new().emulate_tool_from_mouse(false);
        // The builder panics where Windows refuses, which must not end the window.
        let built = catch_unwind(AssertUnwindSafe(|| builder.build_shared(window)));
        Some(match built {
            Ok(Ok(manager)) => Ok(Tablet {
                buttons: Vec::new(),
                manager,
            }),
            Ok(Err(octotablet::builder::BuildError::Unsupported)) => Err(UNSUPPORTED.to_owned()),
            Ok(Err(error)) => Err(format!("Tablets cannot be asked: {error}. Pens work as a mouse does.")),
            Err(_) => Err("Tablets cannot be asked, since the system refuses. Pens work as a mouse does.".to_owned()),
        })
    }

    /// Returns true if the system knows a tablet.
    pub(super) fn is_known(&self) -> bool {
        !self.manager.tablets().is_empty()
    }

    /// Events since the last time, or the reason that none will come any more.
    pub(super) fn pump(&mut self) -> Result<Vec<PenEvent>, String> {
        let Tablet { manager, buttons } = self;
        let pumped = catch_unwind(AssertUnwindSafe(|| {
            let events = manager.pump()?;
            let tools = events.into_iter().flat_map(|event| match event {
                Event::Tool { tool, event } => pen_events(tool, event, buttons),
                Event::Tablet { .. } | Event::Pad { .. } => [None; 2],
            });
            Ok::<_, octotablet::PumpError>(tools.flatten().collect())
        }));
        match pumped {
            Ok(Ok(events)) => Ok(events),
            Ok(Err(error)) => Err(format!(
                "The tablet is lost: {error}. Open Sabi again to paint with it."
            )),
            Err(_) => Err("The tablet is lost. Open Sabi again to paint with it.".to_owned()),
        }
    }
}

/// Converts an event of a tool.
fn pen_events(tool: &Tool, event: ToolEvent<'_>, buttons: &mut Vec<ButtonID>) -> [Option<PenEvent>; 2] {
    // Fingers on a tablet move the pointer by themselves.
    if matches!(tool.tool_type, Some(Type::Finger | Type::Emulated)) {
        return [None; 2];
    }
    let near = PenEvent::Near {
        is_eraser: tool.tool_type == Some(Type::Eraser),
    };
    let event = match event {
        ToolEvent::In { .. } => near,
        ToolEvent::Pose(pose) => PenEvent::Moved {
            at: pose.position,
            pressure: pose.pressure.get(),
            tilt_degrees: pose.tilt.map(|tilt| tilt.map(f32::to_degrees)),
        },
        // A tool that comes near and touches at once is only reported as touching.
        ToolEvent::Down => return [Some(near), Some(PenEvent::Down)],
        ToolEvent::Up => PenEvent::Up,
        // Windows counts the tip among the buttons, and does not say which one it is.
        ToolEvent::Button { .. } if cfg!(windows) => return [None; 2],
        ToolEvent::Button { button_id, pressed } => {
            if !buttons.contains(&button_id) {
                buttons.push(button_id);
            }
            PenEvent::Button {
                is_first: buttons.first() == Some(&button_id),
                is_pressed: pressed,
            }
        }
        ToolEvent::Frame(_) => PenEvent::Frame,
        ToolEvent::Out | ToolEvent::Removed => PenEvent::Left,
        ToolEvent::Added => return [None; 2],
    };
    [Some(event), None]
}
