//! Color spaces that PNG files declare (PNG specification, third edition, 4.3).

use sabi_color::linear_from_srgb_f64;
use zlib_rs::{Inflate, InflateFlush};

use crate::{DeclaredColorSpace, PictureRemarks};

/// Declared color space, and clauses about what of it is not applied.
pub(crate) struct PngColor {
    pub(crate) space: DeclaredColorSpace,
    pub(crate) remarks: PictureRemarks,
}

impl PngColor {
    fn known(space: DeclaredColorSpace) -> PngColor {
        PngColor {
            space,
            remarks: PictureRemarks::default(),
        }
    }

    /// Adds a clause about something that is not applied, such as `the curve PQ (cICP)`.
    fn without(mut self, what: &str) -> PngColor {
        self.remarks.color.push(format!(
            "declares {what}, which Sabi does not apply; convert the picture to sRGB to see the same colors"
        ));
        self
    }
}

/// Returns the color space that the chunks of a PNG declare. Newer types of chunks take precedence.
pub(crate) fn declared_by_png(info: &png::Info<'_>, bytes: &[u8]) -> PngColor {
    if let Some(cicp) = &info.coding_independent_code_points {
        return declared_by_cicp(cicp);
    }
    if let Some(chunk) = profile_chunk(bytes) {
        return declared_by_profile(&unpacked_profile(chunk));
    }
    if info.srgb.is_some() {
        return PngColor::known(DeclaredColorSpace::Srgb);
    }
    let color = info
        .gama_chunk
        .map_or(PngColor::known(DeclaredColorSpace::Unknown), |gamma| {
            declared_by_gamma(gamma.into_value())
        });
    match &info.chrm_chunk {
        Some(primaries) if !is_srgb_primaries(primaries) => color.without("primaries other than those of sRGB (cHRM)"),
        _ => color,
    }
}

/// Gamma of the file to that of 2.2 is the customary way to declare sRGB. A gamma of 0 has no meaning (PNG, 13.13).
fn declared_by_gamma(gamma: f32) -> PngColor {
    const PLAUSIBLE: std::ops::RangeInclusive<f32> = 0.1..=10.0;
    match gamma {
        _ if gamma == 0.0 => PngColor::known(DeclaredColorSpace::Unknown),
        _ if (gamma - 1.0).abs() < 0.005 => PngColor::known(DeclaredColorSpace::Linear),
        _ if (gamma - 1.0 / 2.2).abs() < 0.005 => PngColor::known(DeclaredColorSpace::Srgb),
        _ if PLAUSIBLE.contains(&gamma) => PngColor::known(DeclaredColorSpace::Power(1.0 / gamma)),
        _ => PngColor::known(DeclaredColorSpace::Unknown).without(&format!("a gamma of {gamma} (gAMA)")),
    }
}

/// Color space by code points (ITU-T H.273, tables 2 and 3).
fn declared_by_cicp(cicp: &png::CodingIndependentCodePoints) -> PngColor {
    const UNSPECIFIED: u8 = 2;
    let unknown = PngColor::known(DeclaredColorSpace::Unknown);
    let mut color = match cicp.transfer_function {
        4 => PngColor::known(DeclaredColorSpace::Power(2.2)),
        5 => PngColor::known(DeclaredColorSpace::Power(2.8)),
        8 => PngColor::known(DeclaredColorSpace::Linear),
        13 => PngColor::known(DeclaredColorSpace::Srgb),
        UNSPECIFIED => unknown,
        1 | 6 | 14 | 15 => unknown.without("the curve of BT.709 (cICP)"),
        16 => unknown.without("the curve PQ (cICP)"),
        18 => unknown.without("the curve HLG (cICP)"),
        other => unknown.without(&format!("the curve {other} of H.273 (cICP)")),
    };
    color = match cicp.color_primaries {
        1 | UNSPECIFIED => color,
        9 => color.without("the primaries of BT.2020 (cICP)"),
        11 | 12 => color.without("the primaries of P3 (cICP)"),
        other => color.without(&format!("the primaries {other} of H.273 (cICP)")),
    };
    match cicp.is_video_full_range_image {
        true => color,
        false => color.without("the narrow range of video (cICP)"),
    }
}

fn is_srgb_primaries(given: &png::SourceChromaticities) -> bool {
    const SRGB: [[f32; 2]; 4] = [[0.3127, 0.329], [0.64, 0.33], [0.3, 0.6], [0.15, 0.06]];
    let given = [given.white, given.red, given.green, given.blue];
    let near = |(x, y): (png::ScaledFloat, png::ScaledFloat), own: [f32; 2]| {
        (x.into_value() - own[0]).abs() < 0.005 && (y.into_value() - own[1]).abs() < 0.005
    };
    given.into_iter().zip(SRGB).all(|(given, own)| near(given, own))
}

/// Returns the data of the chunk with a color profile, which precedes the pixels of a PNG.
pub(crate) fn profile_chunk(bytes: &[u8]) -> Option<&[u8]> {
    const SIGNATURE_BYTES: usize = 8;
    let mut rest = bytes.get(SIGNATURE_BYTES..)?;
    // Each chunk consists of its length, its type, its data and a checksum.
    while let Some((length, after)) = rest.split_first_chunk::<4>() {
        let (kind, data) = after.split_first_chunk::<4>()?;
        let length = u32::from_be_bytes(*length) as usize;
        match kind {
            b"iCCP" => return Some(&data[..length.min(data.len())]),
            b"IDAT" | b"IEND" => return None,
            _ => rest = data.get(length.saturating_add(4)..)?,
        }
    }
    None
}

/// Returns the beginning of the profile in a chunk: 64 KiB, since a small chunk may unpack to gigabytes, and profiles with simple curves
/// are smaller.
fn unpacked_profile(chunk: &[u8]) -> Vec<u8> {
    const MOST_BYTES: usize = 1 << 16;
    // The name ends with a zero, and the method of compression, which is always 0, follows.
    let Some(end) = chunk.iter().position(|byte| *byte == 0) else {
        return Vec::new();
    };
    let packed = chunk.get(end + 2..).unwrap_or_default(); // A chunk that ends here has no profile.
    let mut profile = vec![0; MOST_BYTES];
    let mut inflate = Inflate::new(true, 15);
    match inflate.decompress(packed, &mut profile, InflateFlush::NoFlush) {
        Ok(_) => profile.truncate(inflate.total_out() as usize),
        Err(_) => profile.clear(),
    }
    profile
}

/// Color space of a profile (ICC.1:2022). A profile with a table of colors instead of curves is not applied.
fn declared_by_profile(profile: &[u8]) -> PngColor {
    let unknown = PngColor::known(DeclaredColorSpace::Unknown);
    let spaces: Option<Vec<DeclaredColorSpace>> = match profile_tag(profile, b"kTRC") {
        Some(gray) => profile_curve(gray).map(|space| vec![space]),
        None => [b"rTRC", b"gTRC", b"bTRC"]
            .map(|tag| profile_tag(profile, tag).and_then(profile_curve))
            .into_iter()
            .collect(),
    };
    let color = match spaces.as_deref() {
        Some([first, others @ ..]) if others.iter().all(|other| first.is_near(*other)) => PngColor::known(*first),
        _ => return unknown.without("a color profile whose curves are not simple ones (iCCP)"),
    };
    match has_srgb_primaries(profile) {
        true => color,
        false => color.without("a color profile with primaries other than those of sRGB (iCCP)"),
    }
}

/// Returns whether the primaries of a profile are those of sRGB, adapted to D50 as in all profiles. Profiles for gray have none.
fn has_srgb_primaries(profile: &[u8]) -> bool {
    const SRGB: [(&[u8; 4], [f64; 3]); 3] = [
        (b"rXYZ", [0.4361, 0.2225, 0.0139]),
        (b"gXYZ", [0.3851, 0.7169, 0.0971]),
        (b"bXYZ", [0.1431, 0.0606, 0.7141]),
    ];
    SRGB.iter().all(|(tag, own)| {
        let Some(data) = profile_tag(profile, tag) else {
            return profile_tag(profile, b"kTRC").is_some();
        };
        let near = |axis: usize| fixed(data, 8 + 4 * axis).is_some_and(|value| (value - own[axis]).abs() < 0.01);
        (0..3).all(near)
    })
}

/// Returns the data of a tag of a profile.
fn profile_tag<'p>(profile: &'p [u8], tag: &[u8; 4]) -> Option<&'p [u8]> {
    const HEADER_BYTES: usize = 128;
    const ENTRY_BYTES: usize = 12;
    let count = word(profile, HEADER_BYTES)? as usize;
    let entries = profile.get(HEADER_BYTES + 4..)?.chunks_exact(ENTRY_BYTES).take(count);
    let entry = entries.into_iter().find(|entry| entry.starts_with(tag))?;
    profile.get(word(entry, 4)? as usize..)?.get(..word(entry, 8)? as usize)
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(*bytes.get(at..)?.first_chunk()?))
}

/// Reads a number with 16 bits behind the point (s15Fixed16Number).
fn fixed(bytes: &[u8], at: usize) -> Option<f64> {
    Some(f64::from(word(bytes, at)? as i32) / 65536.0)
}

/// Returns the color space that has a curve of a profile: sRGB, linear or a power. Other curves have none.
fn profile_curve(data: &[u8]) -> Option<DeclaredColorSpace> {
    let half = |at: usize| Some(u16::from_be_bytes(*data.get(at..)?.first_chunk()?));
    match data.first_chunk()? {
        b"curv" => match word(data, 8)? as usize {
            0 => Some(DeclaredColorSpace::Linear),
            1 => power(f64::from(half(12)?) / 256.0),
            count => {
                let codes = data.get(12..)?.as_chunks::<2>().0.get(..count)?;
                let values: Vec<f64> = codes
                    .iter()
                    .map(|code| f64::from(u16::from_be_bytes(*code)) / 65535.0)
                    .collect();
                let last = (count - 1) as f64;
                likeness(values.iter().enumerate().map(|(at, value)| (at as f64 / last, *value)))
            }
        },
        b"para" => {
            let kind = half(8)?;
            let parameter = |at: usize| fixed(data, 12 + 4 * at);
            if kind == 0 {
                return power(parameter(0)?);
            }
            const PARAMETERS: [usize; 5] = [1, 3, 4, 5, 7];
            let count = *PARAMETERS.get(usize::from(kind))?;
            let given = (0..count).map(parameter).collect::<Option<Vec<f64>>>()?;
            let curve = |x: f64| parametric(&given, x);
            likeness((0..=255).map(|at| f64::from(at) / 255.0).map(|x| (x, curve(x))))
        }
        _ => None,
    }
}

/// Value of a parametric curve with three, four, five or seven parameters (ICC.1:2022, table 68).
fn parametric(given: &[f64], x: f64) -> f64 {
    match *given {
        [g, a, b] => {
            if a * x + b >= 0.0 {
                (a * x + b).powf(g)
            } else {
                0.0
            }
        }
        [g, a, b, c] => c + if a * x + b >= 0.0 { (a * x + b).powf(g) } else { 0.0 },
        [g, a, b, c, d] => {
            if x >= d {
                (a * x + b).powf(g)
            } else {
                c * x
            }
        }
        [g, a, b, c, d, e, f] => {
            if x >= d {
                (a * x + b).powf(g) + e
            } else {
                c * x + f
            }
        }
        _ => f64::NAN,
    }
}

fn power(exponent: f64) -> Option<DeclaredColorSpace> {
    match exponent {
        _ if (exponent - 1.0).abs() < 0.005 => Some(DeclaredColorSpace::Linear),
        _ if (0.1..=10.0).contains(&exponent) => Some(DeclaredColorSpace::Power(exponent as f32)),
        _ => None,
    }
}

/// Returns the color space whose curve goes through these points: sRGB, linear or a power.
fn likeness(points: impl Iterator<Item = (f64, f64)> + Clone) -> Option<DeclaredColorSpace> {
    let is_like = |curve: &dyn Fn(f64) -> f64| points.clone().all(|(x, y)| (curve(x) - y).abs() < 0.002);
    if is_like(&linear_from_srgb_f64) {
        return Some(DeclaredColorSpace::Srgb);
    }
    let (x, y) = points
        .clone()
        .find(|(x, _)| *x >= 0.5)
        .filter(|(x, y)| *x < 1.0 && *y > 0.0)?;
    let exponent = y.ln() / x.ln();
    if is_like(&|x| x.powf(exponent)) {
        power(exponent)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a profile with these tags, each 4-byte aligned.
    fn profile(tags: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
        let mut file = vec![0; 128];
        file.extend((tags.len() as u32).to_be_bytes());
        let mut at = 132 + 12 * tags.len();
        for (tag, data) in tags {
            file.extend(*tag);
            file.extend((at as u32).to_be_bytes());
            file.extend((data.len() as u32).to_be_bytes());
            at += data.len();
        }
        tags.iter().for_each(|(_, data)| file.extend(data));
        file
    }

    fn curv(values: &[u16]) -> Vec<u8> {
        let mut data = b"curv\0\0\0\0".to_vec();
        data.extend((values.len() as u32).to_be_bytes());
        values.iter().for_each(|value| data.extend(value.to_be_bytes()));
        data
    }

    fn para(kind: u16, parameters: &[f64]) -> Vec<u8> {
        let mut data = b"para\0\0\0\0".to_vec();
        data.extend(kind.to_be_bytes());
        data.extend([0, 0]);
        for parameter in parameters {
            data.extend(((parameter * 65536.0).round() as i32).to_be_bytes());
        }
        data
    }

    fn xyz(values: [f64; 3]) -> Vec<u8> {
        let mut data = b"XYZ \0\0\0\0".to_vec();
        values
            .iter()
            .for_each(|value| data.extend(((value * 65536.0) as i32).to_be_bytes()));
        data
    }

    fn rgb(curve: &[u8], red: [f64; 3]) -> PngColor {
        let tags: [(&[u8; 4], Vec<u8>); 6] = [
            (b"rTRC", curve.to_vec()),
            (b"gTRC", curve.to_vec()),
            (b"bTRC", curve.to_vec()),
            (b"rXYZ", xyz(red)),
            (b"gXYZ", xyz([0.3851, 0.7169, 0.0971])),
            (b"bXYZ", xyz([0.1431, 0.0606, 0.7141])),
        ];
        declared_by_profile(&profile(&tags))
    }

    const RED: [f64; 3] = [0.4361, 0.2225, 0.0139];

    #[test]
    fn simple_curves_of_profiles_are_recognized() {
        let space = |curve: Vec<u8>| {
            let color = rgb(&curve, RED);
            assert_eq!(color.remarks, PictureRemarks::default());
            color.space
        };
        assert_eq!(space(curv(&[])), DeclaredColorSpace::Linear);
        assert_eq!(space(curv(&[256])), DeclaredColorSpace::Linear);
        assert_eq!(space(curv(&[0, 65535 / 2 + 1, 65535])), DeclaredColorSpace::Linear);
        assert_eq!(space(curv(&[0x0180])), DeclaredColorSpace::Power(1.5));
        assert_eq!(space(para(0, &[1.5])), DeclaredColorSpace::Power(1.5));
        // IEC 61966-2-1 as most profiles write it.
        let srgb = [2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.04045];
        assert_eq!(space(para(3, &srgb)), DeclaredColorSpace::Srgb);
        let table: Vec<u16> = (0..1024)
            .map(|at| (65535.0 * linear_from_srgb_f64(f64::from(at) / 1023.0)).round() as u16)
            .collect();
        assert_eq!(space(curv(&table)), DeclaredColorSpace::Srgb);
        let gray = declared_by_profile(&profile(&[(b"kTRC", curv(&[0x0180]))]));
        assert_eq!(
            (gray.space, gray.remarks.color.len()),
            (DeclaredColorSpace::Power(1.5), 0)
        );
    }

    #[test]
    fn what_of_a_profile_is_not_applied_is_told() {
        let told = |color: PngColor| (color.space, color.remarks.color.join("; "));
        // L* of CIELAB, which no power is near to.
        let lightness = [3.0, 1.0 / 1.16, 0.16 / 1.16, 2700.0 / 24389.0, 0.08];
        let (space, remark) = told(rgb(&para(3, &lightness), RED));
        assert_eq!(space, DeclaredColorSpace::Unknown);
        assert!(remark.contains("whose curves are not simple ones (iCCP)"), "{remark}");
        let (space, remark) = told(rgb(&curv(&[0x0180]), [0.6097, 0.3111, 0.0195]));
        assert_eq!(space, DeclaredColorSpace::Power(1.5));
        assert!(remark.contains("primaries other than those of sRGB (iCCP)"), "{remark}");
        for damaged in [
            vec![],
            vec![0; 200],
            profile(&[(b"kTRC", curv(&[1, 2, 3])[..14].to_vec())]),
        ] {
            let (space, remark) = told(declared_by_profile(&damaged));
            assert_eq!((space, remark.is_empty()), (DeclaredColorSpace::Unknown, false));
        }
    }

    #[test]
    fn code_points_are_applied_or_told() {
        let declared = |color_primaries: u8, transfer_function: u8| {
            let color = declared_by_cicp(&png::CodingIndependentCodePoints {
                color_primaries,
                transfer_function,
                matrix_coefficients: 0,
                is_video_full_range_image: true,
            });
            (color.space, color.remarks.color.join("; "))
        };
        assert_eq!(declared(1, 13), (DeclaredColorSpace::Srgb, String::new()));
        assert_eq!(declared(2, 2), (DeclaredColorSpace::Unknown, String::new()));
        assert_eq!(declared(1, 4), (DeclaredColorSpace::Power(2.2), String::new()));
        let (space, remark) = declared(9, 16);
        assert_eq!(space, DeclaredColorSpace::Unknown);
        assert_eq!(
            remark,
            "declares the curve PQ (cICP), which Sabi does not apply; convert the picture to sRGB to see the same colors; \
             declares the primaries of BT.2020 (cICP), which Sabi does not apply; convert the picture to sRGB to see the same colors"
        );
    }

    #[test]
    fn a_gamma_is_the_inverse_of_the_exponent_and_0_has_no_meaning() {
        let declared = |gamma: f32| {
            let color = declared_by_gamma(gamma);
            (color.space, color.remarks.color.len())
        };
        assert_eq!(declared(0.0), (DeclaredColorSpace::Unknown, 0));
        assert_eq!(declared(0.5), (DeclaredColorSpace::Power(2.0), 0));
        assert_eq!(declared(40.0), (DeclaredColorSpace::Unknown, 1));
    }
}
