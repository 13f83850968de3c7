//! The options `--locator` and `--filter`: the parts of a P2M index that may be chosen.

use crate::io::usage::{choices, usage};
use clap::builder::TypedValueParser;
use p2m_backends::{ListFilterKind, LocatorKind, P2mSettings};

#[derive(clap::Args)]
pub(crate) struct P2mArgs {
    /// How --backend p2m finds the nearest vertex [default: grid]
    #[arg(long, value_parser = locators(), ignore_case = true)]
    locator: Option<LocatorKind>,

    /// How --backend p2m searches long lists [default: sorted]
    #[arg(long, value_parser = list_filters(), ignore_case = true)]
    filter: Option<ListFilterKind>,
}

fn locators() -> impl TypedValueParser<Value = LocatorKind> {
    choices([
        ("grid", "A grid with a vertex in each cell", LocatorKind::Grid),
        #[cfg(feature = "paper")]
        ("kd-tree", "A KD-tree, as in Zong et al. 2023: up to three times as slow", LocatorKind::KdTree),
    ])
}

fn list_filters() -> impl TypedValueParser<Value = ListFilterKind> {
    choices([
        ("sorted", "In the order of bounds on distances", ListFilterKind::Sorted),
        #[cfg(feature = "paper")]
        ("r-tree", "By R-trees, as in Zong et al. 2023: up to ten times as slow for long lists", ListFilterKind::RTree),
    ])
}

impl P2mArgs {
    /// Whether neither option was given.
    pub(crate) fn is_unspecified(&self) -> bool {
        self.locator.is_none() && self.filter.is_none()
    }

    /// Returns the settings that the options request.
    ///
    /// # Errors
    /// If one was given for a backend without these settings.
    pub(crate) fn settings(&self, has_p2m_settings: bool) -> anyhow::Result<P2mSettings> {
        if !has_p2m_settings && !self.is_unspecified() {
            let option = if self.locator.is_some() { "--locator" } else { "--filter" };
            return Err(usage(format!("{option} is for --backend p2m")));
        }
        let (locator, filter) = (self.locator.unwrap_or_default(), self.filter.unwrap_or_default());
        Ok(P2mSettings::default().with_locator(locator).with_list_filter(filter))
    }

    /// Refuses settings that a saved index cannot have.
    ///
    /// # Errors
    /// If another locator than the grid, or a filter, was requested.
    pub(crate) fn check_saveable(&self) -> anyhow::Result<()> {
        if self.settings(true)? == P2mSettings::default() {
            return Ok(());
        }
        Err(usage(
            "a saved index has --locator grid and --filter sorted: others are built by the command that searches",
        ))
    }
}
