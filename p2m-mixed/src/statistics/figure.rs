//! Display of numbers for people.

use std::fmt;

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

/// A number that is displayed with four significant digits: `0.03125`, `1,234`. Numbers from a hundred thousand up and
/// below a thousandth have an exponent: `4.45e5`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure(pub f64);

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let x = self.0;
        if x == 0.0 {
            return f.pad("0");
        }
        // The number is rounded before its exponent is examined, so that 99,999.9 becomes 1e5.
        let scientific = format!("{x:.3e}");
        let Some((mantissa, exponent)) = scientific.split_once('e') else { return f.pad(&scientific) };
        let exponent: i32 = exponent.parse().unwrap_or(0);
        let text = if !(-3..5).contains(&exponent) {
            format!("{}e{exponent}", trim(mantissa))
        } else if exponent == 4 {
            let rounded: f64 = scientific.parse().unwrap_or(x);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "five digits")]
            let count = Count(rounded.abs() as u64);
            format!("{}{count}", if x < 0.0 { "-" } else { "" })
        } else {
            let decimals = usize::try_from(3 - exponent).unwrap_or(0);
            let plain = trim(&format!("{x:.decimals$}")).to_owned();
            match plain.strip_prefix('-').unwrap_or(&plain).parse::<u64>() {
                Ok(count) if count >= 1000 => format!("{}{}", if x < 0.0 { "-" } else { "" }, Count(count)),
                _ => plain,
            }
        };
        f.pad(&text)
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
            (0.000_5, "5e-4"),
            (12.345_67, "12.35"),
            (999.96, "1,000"),
            (1234.5, "1,234"),
            (-1234.5, "-1,234"),
            (43_554.0, "43,550"),
            (99_999.9, "1e5"),
            (444_812.0, "4.448e5"),
            (1e300, "1e300"),
            (-4e-310, "-4e-310"),
        ] {
            assert_eq!(Figure(x).to_string(), expected);
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
