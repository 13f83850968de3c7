//! Wrong usage that the grammar of the arguments does not show.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::fmt;
use std::str::FromStr;

/// What is wrong with the arguments; ends the program with code 2.
#[derive(Debug)]
pub(crate) struct Usage(String);

impl fmt::Display for Usage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

pub(crate) fn usage(message: impl Into<String>) -> anyhow::Error {
    Usage(message.into()).into()
}

/// A parser of the names of formats, which shows them in the help and to the completions of shells.
pub(crate) fn one_of<F>(names: &'static [&'static str]) -> impl TypedValueParser<Value = F>
where
    F: FromStr + Clone + Send + Sync + 'static,
    F::Err: std::error::Error + Send + Sync + 'static,
{
    PossibleValuesParser::new(names).try_map(|name| name.parse::<F>())
}

/// Value parsers, each with what it expects as its message.
pub(crate) fn whole(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("not a whole number from 0 to {}", u64::MAX))
}

pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x),
        _ => Err("not a positive number".to_owned()),
    }
}

pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x >= 0.0 => Ok(x),
        _ => Err("not a number from 0 up".to_owned()),
    }
}

pub(crate) fn finite_not_negative(text: &str) -> Result<f64, String> {
    not_negative(text).ok().filter(|x| x.is_finite()).ok_or_else(|| "not a finite number from 0 up".to_owned())
}

pub(crate) fn number(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if !x.is_nan() => Ok(x),
        _ => Err("not a number".to_owned()),
    }
}

pub(crate) fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err("not a finite number".to_owned()),
    }
}
