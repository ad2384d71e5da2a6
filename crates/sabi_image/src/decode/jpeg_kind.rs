//! Kinds of JPEG files by their frame header (ITU-T T.81, B.1 and B.2.2).

/// Returns a clause about the feature of a valid JPEG that is not read. Damage is reported later by the decoder.
pub(super) fn unread_feature(bytes: &[u8]) -> Option<String> {
    let frame = frame(bytes)?;
    let number = frame.marker.wrapping_sub(SOF0);
    match frame.marker {
        0xc0..=0xc2 if frame.precision == 12 => Some("it has 12 bits for each sample, which are not read".to_owned()),
        0xc0..=0xc2 => None,
        0xc3 => Some("it is a lossless JPEG (SOF3), which is not read".to_owned()),
        0xc5..=0xc7 => Some(format!("it is a hierarchical JPEG (SOF{number}), which is not read")),
        SOF55 => Some("it is a JPEG-LS file (SOF55), which is not read".to_owned()),
        _ => Some(format!("it has arithmetic coding (SOF{number}), which is not read")),
    }
}

const SOF0: u8 = 0xc0;
/// Frame of JPEG-LS (ITU-T T.87, C.1.1).
const SOF55: u8 = 0xf7;

/// Frame header of a JPEG.
struct Frame {
    marker: u8,
    /// Bits of a sample.
    precision: u8,
}

/// Finds the first frame header, which precedes all scans.
fn frame(bytes: &[u8]) -> Option<Frame> {
    const START_OF_SCAN: u8 = 0xda;
    const END_OF_IMAGE: u8 = 0xd9;
    let mut rest = bytes.get(2..)?;
    while let [0xff, marker, after @ ..] = rest {
        match *marker {
            // Any number of fill bytes may precede a marker.
            0xff => rest = &rest[1..],
            // Markers without a segment.
            0x01 | 0xd0..=0xd8 => rest = after,
            START_OF_SCAN | END_OF_IMAGE => return None,
            // All other markers from C0 to CF start a frame, except tables of codes (C4, CC) and a reserved one (C8).
            0xc0..=0xc3 | 0xc5..=0xc7 | 0xc9..=0xcb | 0xcd..=0xcf | SOF55 => {
                return Some(Frame {
                    marker: *marker,
                    precision: *after.get(2)?,
                });
            }
            _ => rest = after.get(usize::from(u16::from_be_bytes(*after.first_chunk()?))..)?,
        }
    }
    None
}
