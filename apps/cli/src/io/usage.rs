//! Errors of usage that the grammar of the arguments does not detect, and parsers of values.

use bytesize::ByteSize;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::fmt;
use std::str::FromStr;

/// An error of the arguments, which ends the program with code 2.
#[derive(Debug)]
pub(crate) struct Usage(String);

impl fmt::Display for Usage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// Returns an error of usage with this message.
pub(crate) fn usage(message: impl Into<String>) -> anyhow::Error {
    Usage(message.into()).into()
}

/// Returns a parser of the names of formats, which help and completions of shells show.
pub(crate) fn one_of<F>(names: &'static [&'static str]) -> impl TypedValueParser<Value = F>
where
    F: FromStr + Clone + Send + Sync + 'static,
    F::Err: std::error::Error + Send + Sync + 'static,
{
    PossibleValuesParser::new(names).try_map(|name| name.parse::<F>())
}

/// Returns a parser of names, which are given with their help and with the values that they stand for.
pub(crate) fn choices<T: Clone + Send + Sync + 'static>(
    choices: impl IntoIterator<Item = (&'static str, &'static str, T)>,
) -> impl TypedValueParser<Value = T> {
    let choices: Vec<_> = choices.into_iter().collect();
    let names: Vec<_> = choices.iter().map(|(name, help, _)| PossibleValue::new(*name).help(*help)).collect();
    PossibleValuesParser::new(names).map(move |found| {
        let choice = choices.iter().find(|(name, ..)| name.eq_ignore_ascii_case(&found));
        choice.expect("the parser accepts these names alone").2.clone()
    })
}

/// Parses a whole number.
pub(crate) fn whole_number(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("not a whole number from 0 to {}", u64::MAX))
}

/// Parses a count, which may have an exponent and marks between its digits, as 1e6 and 1_000_000 have.
pub(crate) fn count(text: &str) -> Result<u64, String> {
    let digits = text.replace(['_', ','], "");
    let with_exponent = || {
        let (mantissa, exponent) = digits.split_once(['e', 'E'])?;
        mantissa.parse::<u64>().ok()?.checked_mul(10u64.checked_pow(exponent.parse().ok()?)?)
    };
    let number = digits.parse().ok().or_else(with_exponent);
    number.ok_or_else(|| format!("not a whole number from 0 to {}, such as 1000, 1_000 or 1e3", u64::MAX))
}

/// Parses a count of at least `least` and at most `most`.
pub(crate) fn count_in(text: &str, least: u64, most: u64) -> Result<u64, String> {
    let number = count(text)?;
    if (least..=most).contains(&number) { Ok(number) } else { Err(format!("{number} is not in {least}..={most}")) }
}

/// Parses an amount of memory, such as 4GB, 500 MiB or 1000000.
pub(crate) fn bytes(text: &str) -> Result<u64, String> {
    match text.parse::<ByteSize>() {
        Ok(size) if size.as_u64() > 0 => Ok(size.as_u64()),
        _ => Err("not an amount of memory, such as 4GB, 500MiB or 1000000".to_owned()),
    }
}

/// Parses a number for which `is_right` holds, and which messages call `what`.
pub(crate) fn number_that(text: &str, is_right: impl Fn(&f64) -> bool, what: &str) -> Result<f64, String> {
    text.parse().ok().filter(is_right).ok_or_else(|| format!("not a {what}"))
}

/// Parses a positive finite number.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    number_that(text, |x| *x > 0.0 && x.is_finite(), "positive number")
}

/// Parses a number that is not negative; infinity is one.
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    number_that(text, |x| *x >= 0.0, "number from 0 up")
}

/// Parses a finite number that is not negative.
pub(crate) fn finite_not_negative(text: &str) -> Result<f64, String> {
    number_that(text, |x| *x >= 0.0 && x.is_finite(), "finite number from 0 up")
}

/// Parses any number but NaN.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    number_that(text, |x| !x.is_nan(), "number")
}

/// Parses a finite number.
pub(crate) fn finite(text: &str) -> Result<f64, String> {
    number_that(text, |x| x.is_finite(), "finite number")
}
