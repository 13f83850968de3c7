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
    let f = place - i as f64;
    std::array::from_fn(|k| (f64::from(DIVERGING[i][k]) * (1.0 - f) + f64::from(DIVERGING[i + 1][k]) * f) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_those_of_the_script() {
        let hex = DIVERGING.map(|[r, g, b]| format!("\"#{r:02x}{g:02x}{b:02x}\"")).join(",");
        let undefined = UNDEFINED.map(|x| format!("{x:02x}")).concat();
        for hex in [hex, format!("\"#{undefined}\"")] {
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
    }
}
