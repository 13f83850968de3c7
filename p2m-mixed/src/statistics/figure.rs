//! Display of numbers for people.

use std::fmt;
use std::time::Duration;

/// A count that is displayed with separated thousands: `871,414`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Count(pub u64);

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = self.0.to_string();
        let mut text = String::new();
        for (i, digit) in digits.chars().enumerate() {
            if i > 0 && (digits.len() - i).is_multiple_of(3) {
                text.push(',');
            }
            text.push(digit);
        }
        f.pad(&text)
    }
}

/// A number that is displayed with four significant digits: `0.03125`, `1,234`, `444,800`. Numbers from 10^12 up and
/// below 10^-5 have an exponent: `4.45e-6`. Pages display numbers in the same way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure(pub f64);

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&rounded(self.0, 4))
    }
}

/// A number that is displayed with six significant digits, and otherwise as a [`Figure`]: `0.540449`, `12,345.6`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Length(pub f64);

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&rounded(self.0, 6))
    }
}

/// A time that is displayed with three significant digits: `12.3 ms`, `1.80 s`, `930 ns`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Time(pub Duration);

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&three_digits(self.0.as_secs_f64(), [(1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns")]))
    }
}

/// A number per second that is displayed with three significant digits: `1.23 M`, `450 k`, `12.0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rate(pub f64);

impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(three_digits(self.0, [(1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, "")]).trim_end())
    }
}

/// Returns a number with three significant digits, in the largest unit in which it is at least one.
fn three_digits(x: f64, units: [(f64, &str); 4]) -> String {
    // A number that would be rounded to a thousand is in the next unit.
    let (size, unit) = units.into_iter().find(|(size, _)| x >= 0.9995 * size).unwrap_or(units[3]);
    let scaled = x / size;
    let decimals = if scaled >= 99.95 {
        0
    } else if scaled >= 9.995 {
        1
    } else {
        2
    };
    format!("{scaled:.decimals$} {unit}")
}

/// Returns a number with so many significant digits.
fn rounded(x: f64, digits: usize) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    // The number is rounded before its exponent is examined, so that 999,999,999,999 becomes 1e12.
    let scientific = format!("{x:.*e}", digits - 1);
    let Some((mantissa, exponent)) = scientific.split_once('e') else { return scientific };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let most = i32::try_from(digits).unwrap_or(0);
    if !(-5..12).contains(&exponent) {
        return format!("{}e{exponent}", trim(mantissa));
    }
    let value: f64 = scientific.parse().unwrap_or(x);
    let plain = format!("{value:.*}", usize::try_from(most - 1 - exponent).unwrap_or(0));
    let (whole, decimals) = trim(&plain).split_at(trim(&plain).find('.').unwrap_or(trim(&plain).len()));
    let sign = if whole.starts_with('-') { "-" } else { "" };
    match whole.trim_start_matches('-').parse::<u64>() {
        Ok(count) => format!("{sign}{}{decimals}", Count(count)),
        Err(_) => plain,
    }
}

/// A number that is displayed with the fewest digits that identify it: `500000.25`, `-2`, `1e300`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exact(pub f64);

impl fmt::Display for Exact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The sum of -0 and 0 is 0.
        let x = self.0 + 0.0;
        let is_plain = x == 0.0 || (1e-5..1e16).contains(&x.abs());
        f.pad(&if is_plain { format!("{x}") } else { format!("{x:e}") })
    }
}

/// Removes zeros at the end of decimals.
fn trim(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// A percentage that is displayed with two digits: `41 %`, `0.3 %`, `less than 0.1 %`. It is never `0 %` if the part is
/// not 0, and never `100 %` if the part is less than the whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Share {
    /// The number of items in the part.
    pub part: u64,
    /// The number of all items.
    pub whole: u64,
}

impl fmt::Display for Share {
    #[allow(clippy::cast_precision_loss, reason = "a figure of two digits")]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = 100.0 * self.part as f64 / self.whole as f64;
        let text = if self.part == 0 || self.whole == 0 {
            "0 %".to_owned()
        } else if self.part == self.whole {
            "100 %".to_owned()
        } else if percent < 0.1 {
            "less than 0.1 %".to_owned()
        } else if percent > 99.9 {
            "more than 99.9 %".to_owned()
        } else if (9.95..=99.0).contains(&percent) {
            format!("{percent:.0} %")
        } else {
            format!("{} %", trim(&format!("{percent:.1}")))
        };
        f.pad(&text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_their_thousands_apart() {
        for (count, expected) in
            [(0, "0"), (12, "12"), (999, "999"), (1000, "1,000"), (871_414, "871,414"), (1_000_000, "1,000,000")]
        {
            assert_eq!(Count(count).to_string(), expected);
        }
        assert_eq!(format!("{:>7}", Count(1000)), "  1,000");
    }

    #[test]
    fn figures_have_four_digits() {
        for (x, expected) in [
            (0.0, "0"),
            (1.0, "1"),
            (-2.5, "-2.5"),
            (0.031_25, "0.03125"),
            (0.001, "0.001"),
            (0.000_999_96, "0.001"),
            (0.000_5, "0.0005"),
            (0.000_012_346, "0.00001235"),
            (0.000_009_999_6, "0.00001"),
            (-0.000_009_9, "-9.9e-6"),
            (12.345_67, "12.35"),
            (999.96, "1,000"),
            (1234.5, "1,234"),
            (-1234.5, "-1,234"),
            (43_554.0, "43,550"),
            (99_999.9, "100,000"),
            (444_812.0, "444,800"),
            (-999_940_000_000.0, "-999,900,000,000"),
            (999_990_000_000.0, "1e12"),
            (1e300, "1e300"),
            (-4e-310, "-4e-310"),
        ] {
            assert_eq!(Figure(x).to_string(), expected);
        }
    }

    #[test]
    fn lengths_have_six_digits_and_times_three() {
        for (x, expected) in
            [(0.540_449_148, "0.540449"), (12_345.678, "12,345.7"), (-1e6, "-1,000,000"), (3e7, "30,000,000")]
        {
            assert_eq!(Length(x).to_string(), expected);
        }
        for (nanoseconds, expected) in [
            (0, "0.00 ns"),
            (930, "930 ns"),
            (12_345_678, "12.3 ms"),
            (999_600_000, "1.00 s"),
            (75_400_000_000, "75.4 s"),
        ] {
            assert_eq!(Time(Duration::from_nanos(nanoseconds)).to_string(), expected);
        }
        for (x, expected) in [(0.5, "0.50"), (12.0, "12.0"), (813_123.0, "813 k"), (1_235_084.0, "1.24 M")] {
            assert_eq!(Rate(x).to_string(), expected);
        }
    }

    #[test]
    fn exact_numbers_keep_their_digits() {
        for (x, expected) in
            [(-0.0, "0"), (0.1, "0.1"), (500_000.25, "500000.25"), (-2.0, "-2"), (1e300, "1e300"), (-5e-324, "-5e-324")]
        {
            assert_eq!(Exact(x).to_string(), expected);
        }
    }

    #[test]
    fn shares_do_not_pretend() {
        for (part, whole, expected) in [
            (0, 7, "0 %"),
            (0, 0, "0 %"),
            (7, 7, "100 %"),
            (1, 100_000, "less than 0.1 %"),
            (1, 1500, "less than 0.1 %"),
            (99_999, 100_000, "more than 99.9 %"),
            (41, 100, "41 %"),
            (1, 300, "0.3 %"),
            (1, 50, "2 %"),
            (995, 1000, "99.5 %"),
        ] {
            assert_eq!(Share { part, whole }.to_string(), expected);
        }
    }
}
