//! The colours of signed numbers. The script of the page has the same scale.

/// Blue for negative numbers and red for positive ones, almost white at zero, which people with any colour vision tell
/// apart.
const DIVERGING: [[u8; 3]; 11] = [
    [0x08, 0x30, 0x6b],
    [0x1c, 0x5a, 0xa8],
    [0x4a, 0x8f, 0xd0],
    [0x8f, 0xc0, 0xea],
    [0xcf, 0xe4, 0xf4],
    [0xf4, 0xf1, 0xea],
    [0xf9, 0xd3, 0xb8],
    [0xf0, 0xa3, 0x7c],
    [0xdd, 0x6a, 0x4e],
    [0xb9, 0x32, 0x37],
    [0x7a, 0x0a, 0x22],
];
/// The colours of bands: at the limit below a tolerance and beyond it, just below the tolerance, within, just above, and at
/// the limit above and beyond it.
const BANDS: [[u8; 3]; 5] =
    [[0x1d, 0x4f, 0xc0], [0x0c, 0x92, 0xb0], [0x3c, 0x96, 0x50], [0xb3, 0x83, 0x00], [0xc4, 0x24, 0x1f]];
/// The colour of NaN.
const UNDEFINED: [u8; 3] = [0x9a, 0x5f, 0xc0];

/// Returns red, green and blue of a number on a scale from blue at `-limit` over almost white at zero to red at `limit`,
/// as pages show it. Numbers beyond the limit have the colours of its ends, and NaN is violet.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "places and colours are in range")]
pub fn diverging_colour(value: f64, limit: f64) -> [u8; 3] {
    if value.is_nan() {
        return UNDEFINED;
    }
    let last = DIVERGING.len() - 1;
    // A scale without a width has the colour of zero at zero.
    let part = if value == 0.0 { 0.0 } else { (value / limit).clamp(-1.0, 1.0) };
    let place = (0.5 + 0.5 * part) * last as f64;
    let i = (place as usize).min(last - 1);
    mixed(DIVERGING[i], DIVERGING[i + 1], place - i as f64)
}

/// Returns the colour at a part of the way from one to another.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "colours are in range")]
fn mixed(from: [u8; 3], to: [u8; 3], part: f64) -> [u8; 3] {
    std::array::from_fn(|k| (f64::from(from[k]) * (1.0 - part) + f64::from(to[k]) * part) as u8)
}

/// Returns red, green and blue of a number as light pages show it with a tolerance: one colour within, and on either side
/// others that change evenly up to a limit, and stay as they are beyond. NaN is violet.
#[must_use]
pub fn band_colour(value: f64, tolerance: f64, limit: f64) -> [u8; 3] {
    if value.is_nan() {
        return UNDEFINED;
    }
    if value.abs() <= tolerance {
        return BANDS[2];
    }
    let part = if value.abs() < limit { (value.abs() - tolerance) / (limit - tolerance) } else { 1.0 };
    let [near, far] = if value > 0.0 { [BANDS[3], BANDS[4]] } else { [BANDS[1], BANDS[0]] };
    mixed(near, far, part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_those_of_the_script() {
        let hex = |colours: &[[u8; 3]]| {
            let hex = colours.iter().map(|[r, g, b]| format!("\"#{r:02x}{g:02x}{b:02x}\""));
            hex.collect::<Vec<_>>().join(",")
        };
        for hex in [hex(&DIVERGING), hex(&BANDS), hex(&[UNDEFINED])] {
            assert!(include_str!("../assets/viewer.js").contains(&hex), "{hex}");
        }
    }

    #[test]
    fn the_ends_and_the_middle_have_their_colours() {
        let of = |value| diverging_colour(value, 2.0);
        assert_eq!([of(-2.0), of(-3.0), of(0.0)], [DIVERGING[0], DIVERGING[0], DIVERGING[5]]);
        assert_eq!([of(2.0), of(f64::INFINITY), of(f64::NAN)], [DIVERGING[10], DIVERGING[10], UNDEFINED]);
        assert_eq!(of(0.8), DIVERGING[7]);
        assert_eq!([diverging_colour(0.0, 0.0), diverging_colour(1.0, 0.0)], [DIVERGING[5], DIVERGING[10]]);
        let bands = [-9.0, -2.0, -1.0, 0.0, 1.0, 2.0, 9.0].map(|x| band_colour(x, 1.0, 3.0));
        let (below, above) = ([0x14, 0x70, 0xb8], [0xbb, 0x53, 0x0f]);
        assert_eq!(bands, [BANDS[0], below, BANDS[2], BANDS[2], BANDS[2], above, BANDS[4]]);
        assert_eq!([1.0001, 2.9999].map(|x| band_colour(x, 1.0, 3.0)[0]), [BANDS[3][0], BANDS[4][0] - 1]);
        // A limit within the tolerance is none.
        assert_eq!(band_colour(2.0, 1.0, 1.0), BANDS[4]);
        assert_eq!(band_colour(f64::NAN, 1.0, 3.0), UNDEFINED);
    }
}
