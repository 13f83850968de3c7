//! The options `--locator` and `--filter`: the parts of a P2M index that may be chosen.

use crate::io::usage::usage;
use clap::ValueEnum;
use clap::builder::PossibleValue;
use p2m_backends::{ListFilterKind, LocatorKind, P2mSettings};

#[derive(clap::Args)]
pub(crate) struct P2mArgs {
    /// How --backend p2m finds the nearest vertex [default: grid]
    #[arg(long, value_enum, ignore_case = true)]
    locator: Option<Locator>,

    /// How --backend p2m searches long lists [default: sorted]
    #[arg(long, value_enum, ignore_case = true)]
    filter: Option<ListFilter>,
}

/// A value of `--locator`.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Locator(LocatorKind);

impl ValueEnum for Locator {
    fn value_variants<'a>() -> &'a [Self] {
        &[
            Self(LocatorKind::Grid),
            #[cfg(feature = "paper")]
            Self(LocatorKind::KdTree),
        ]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self.0 {
            LocatorKind::Grid => Some(PossibleValue::new("grid").help("A grid with a vertex in each cell")),
            #[cfg(feature = "paper")]
            LocatorKind::KdTree => {
                Some(PossibleValue::new("kd-tree").help("A KD-tree, as in Zong et al. 2023: up to three times as slow"))
            }
            _ => None,
        }
    }
}

/// A value of `--filter`.
#[derive(Clone, Copy, PartialEq, Eq)]
struct ListFilter(ListFilterKind);

impl ValueEnum for ListFilter {
    fn value_variants<'a>() -> &'a [Self] {
        &[
            Self(ListFilterKind::Sorted),
            #[cfg(feature = "paper")]
            Self(ListFilterKind::RTree),
        ]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self.0 {
            ListFilterKind::Sorted => Some(PossibleValue::new("sorted").help("In the order of bounds on distances")),
            #[cfg(feature = "paper")]
            ListFilterKind::RTree => Some(
                PossibleValue::new("r-tree")
                    .help("By R-trees, as in Zong et al. 2023: up to ten times as slow for long lists"),
            ),
            _ => None,
        }
    }
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
        let locator = self.locator.map_or_else(LocatorKind::default, |locator| locator.0);
        let list_filter = self.filter.map_or_else(ListFilterKind::default, |filter| filter.0);
        Ok(P2mSettings::default().with_locator(locator).with_list_filter(list_filter))
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
