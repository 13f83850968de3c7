//! Opening a page in the browser.

use anyhow::{Context, bail};
use std::path::Path;
use std::process::{Command, Stdio};

#[derive(clap::Args)]
pub(crate) struct OpenArgs {
    /// Open the page in the browser: in that of the variable BROWSER, or else the usual one
    #[arg(long)]
    pub(crate) open: bool,
}

impl OpenArgs {
    /// Opens a page that has been written, if that was asked for.
    pub(crate) fn show(&self, page: Option<&Path>) -> anyhow::Result<()> {
        let Some(page) = page.filter(|_| self.open) else { return Ok(()) };
        let browser = std::env::var_os("BROWSER").filter(|name| !name.is_empty());
        let mut command = match browser {
            Some(browser) => Command::new(browser),
            None if cfg!(target_os = "macos") => Command::new("open"),
            None if cfg!(windows) => Command::new("explorer"),
            None => Command::new("xdg-open"),
        };
        let name = command.get_program().to_string_lossy().into_owned();
        command.arg(page).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let status =
            command.status().with_context(|| format!("{} is written, but {name} cannot be run", page.display()))?;
        // The explorer of Windows ends with 1 also when it has opened a page.
        if !status.success() && !cfg!(windows) {
            bail!("{} is written, but {name} did not open it: {status}", page.display());
        }
        Ok(())
    }
}
