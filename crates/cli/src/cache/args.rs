//! [`CacheArgs`]: which cache a command uses.
//!
//! *In:* flags, and the environment where a flag is not given. *Out:* a folder, a limit, an address.

use crate::arguments::sizes;
use crate::exit::Failure;
use clap::Args;
use std::env;
use std::path::PathBuf;

/// The size of a cache without `--cache-limit`.
const LIMIT: u64 = 1 << 30;

/// Where results are kept between runs.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Cache")]
pub(crate) struct CacheArgs {
    /// Keep results in this folder, and take them from there (default: `GLISTEN_CACHE` of the environment)
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// The size that the cache is kept below, such as 500M or 2G (default: `GLISTEN_CACHE_LIMIT`, or 1G)
    #[arg(long, value_name = "SIZE", value_parser = sizes::parse)]
    cache_limit: Option<u64>,
    /// Keep results on this server, too: `http://host:port`, by Bazel's HTTP protocol (default: `GLISTEN_REMOTE_CACHE`)
    #[arg(long, value_name = "URL")]
    remote_cache: Option<String>,
    /// Use no cache, whatever the environment says
    #[arg(long, conflicts_with_all = ["cache", "remote_cache"])]
    no_cache: bool,
}

impl CacheArgs {
    /// The folder.
    pub(crate) fn folder(&self) -> Option<PathBuf> {
        let given = || env::var_os("GLISTEN_CACHE").filter(|value| !value.is_empty()).map(PathBuf::from);
        if self.no_cache { None } else { self.cache.clone().or_else(given) }
    }

    /// The address of the server.
    pub(super) fn remote(&self) -> Option<String> {
        let given = || env::var("GLISTEN_REMOTE_CACHE").ok().filter(|value| !value.is_empty());
        if self.no_cache { None } else { self.remote_cache.clone().or_else(given) }
    }

    /// The limit of the command line.
    pub(crate) fn given_limit(&self) -> Option<u64> {
        self.cache_limit
    }

    /// The limit in bytes.
    ///
    /// # Errors
    /// The environment has no size where there should be one.
    pub(crate) fn limit(&self) -> Result<u64, Failure> {
        if let Some(limit) = self.cache_limit {
            return Ok(limit);
        }
        match env::var("GLISTEN_CACHE_LIMIT").ok().filter(|value| !value.is_empty()) {
            Some(text) => sizes::parse(&text)
                .map_err(|why| Failure::usage(format!("GLISTEN_CACHE_LIMIT of the environment: {why}"))),
            None => Ok(LIMIT),
        }
    }
}
