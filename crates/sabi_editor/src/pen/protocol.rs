//! Versions of the protocols of a Wayland compositor, which are asked for before the tablet protocol is used: a compositor that speaks a
//! newer version of it sends events that the present one does not have, and the connection of the whole window would end.

use wayland_client::globals::{GlobalListContents, registry_queue_init};
use wayland_client::protocol::wl_registry::{Event, WlRegistry};
use wayland_client::protocol::wl_seat::WlSeat;
use wayland_client::{Connection, Dispatch, Proxy, QueueHandle};

use super::UNSUPPORTED;

/// Name of the tablet protocol, and its newest version that `octotablet` knows.
const TABLETS: (&str, u32) = ("zwp_tablet_manager_v2", 1);

/// Checks that the compositor has a known version of the tablet protocol. The error says why there is none.
pub(super) fn check() -> Result<(), String> {
    // A connection of its own; outside of Wayland there is none.
    let Ok(connection) = Connection::connect_to_env() else {
        return Err(UNSUPPORTED.to_owned());
    };
    let asked = registry_queue_init::<RegistryState>(&connection);
    let Ok((globals, _)) = asked else {
        return Err(UNSUPPORTED.to_owned());
    };
    let known = globals.contents().with_list(|globals| {
        let versions = globals.iter().map(|global| (global.interface.clone(), global.version));
        versions.collect::<Vec<_>>()
    });
    suits(&known)
}

fn suits(known: &[(String, u32)]) -> Result<(), String> {
    let newest = |name: &str| {
        let versions = known.iter().filter(|(interface, _)| interface == name);
        versions.map(|(_, version)| *version).max()
    };
    let (tablets, most) = TABLETS;
    match (newest(tablets), newest(WlSeat::interface().name)) {
        (None, _) => Err("This Wayland compositor does not tell of tablets; pens work as a mouse does.".to_owned()),
        (Some(version), Some(seat)) if version <= most && seat <= WlSeat::interface().version => Ok(()),
        _ => Err(
            "This Wayland compositor tells of tablets in a newer way than Sabi knows; pens work as a mouse does."
                .to_owned(),
        ),
    }
}

/// State for the events of the registry, of which nothing is kept.
struct RegistryState;

impl Dispatch<WlRegistry, GlobalListContents> for RegistryState {
    fn event(
        _: &mut RegistryState,
        _: &WlRegistry,
        _: Event,
        _: &GlobalListContents,
        _: &Connection,
        _: &QueueHandle<RegistryState>,
    ) {
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tablets_are_asked_only_in_versions_that_are_known() {
        let asked = |globals: &[(&str, u32)]| {
            let known: Vec<_> = globals
                .iter()
                .map(|(name, version)| ((*name).to_owned(), *version))
                .collect();
            suits(&known)
        };
        assert_eq!(asked(&[("wl_seat", 7), ("zwp_tablet_manager_v2", 1)]), Ok(()));
        let newer = asked(&[("wl_seat", 7), ("zwp_tablet_manager_v2", 2)]).unwrap_err();
        assert!(newer.contains("newer"), "{newer}");
        assert_eq!(
            asked(&[("wl_seat", 99), ("zwp_tablet_manager_v2", 1)]),
            Err(newer.clone())
        );
        assert_eq!(asked(&[("zwp_tablet_manager_v2", 1)]), Err(newer));
        let none = asked(&[("wl_seat", 7)]).unwrap_err();
        assert!(none.contains("does not tell of tablets"), "{none}");
    }
}
