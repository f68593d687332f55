//! [`Remote`]: a cache on another machine, by Bazel's HTTP protocol.
//!
//! *In:* a kind, a digest, bytes. *Out:* `GET` and `PUT` of `/ac/<digest>` and `/cas/<digest>`, as bazel-remote, nginx with
//! WebDAV and others serve them (<https://bazel.build/remote/caching>). *Holds:* after a failure the server is left alone,
//! and the build goes on without it. *Not done here:* encryption, and gRPC; a proxy on
//! the same machine has both.

use super::store::Kind;
use crate::cli::digest::Digest;
use std::sync::Mutex;
use std::time::Duration;

/// How long to wait for a connection, and for an answer as a whole.
const CONNECT: Duration = Duration::from_secs(3);
const ANSWER: Duration = Duration::from_secs(30);
/// The largest entry that is taken.
const MAX_BYTES: u64 = 256 << 20;

/// A server.
pub(super) struct Remote {
    agent: ureq::Agent,
    address: String,
    /// Why the server is asked no more.
    failure: Mutex<Option<String>>,
}

impl Remote {
    /// The server at an address.
    ///
    /// # Errors
    /// An address that is not one of HTTP.
    pub(super) fn new(address: &str) -> Result<Self, String> {
        let address = address.trim_end_matches('/');
        if address.starts_with("https://") || address.starts_with("grpc") {
            return Err(format!(
                "`{address}`: glisten speaks plain HTTP alone; a proxy on this machine can do the rest"
            ));
        }
        if address.strip_prefix("http://").is_none_or(|host| host.is_empty() || host.contains(char::is_whitespace)) {
            return Err(format!("`{address}` is no address; write `http://host:port`"));
        }
        let config = ureq::Agent::config_builder()
            .timeout_connect(Some(CONNECT))
            .timeout_global(Some(ANSWER))
            .http_status_as_error(false)
            .user_agent(concat!("glisten/", env!("CARGO_PKG_VERSION")))
            .build();
        Ok(Self { agent: config.into(), address: address.to_owned(), failure: Mutex::new(None) })
    }

    /// The failure of the server, told once.
    pub(super) fn failure(&self) -> Option<String> {
        self.failure.lock().ok()?.clone()
    }

    fn is_down(&self) -> bool {
        self.failure.lock().map_or(true, |failure| failure.is_some())
    }

    fn fail(&self, why: String) {
        if let Ok(mut failure) = self.failure.lock() {
            failure.get_or_insert(why);
        }
    }

    fn url(&self, kind: Kind, digest: Digest) -> String {
        format!("{}/{}/{digest}", self.address, kind.word())
    }

    /// The bytes of an entry.
    pub(super) fn get(&self, kind: Kind, digest: Digest) -> Option<Vec<u8>> {
        if self.is_down() {
            return None;
        }
        let bytes = match self.try_get(kind, digest) {
            Ok(bytes) => bytes?,
            Err(why) => {
                self.fail(why);
                return None;
            }
        };
        (kind == Kind::Result || Digest::of(&bytes) == digest).then_some(bytes)
    }

    fn try_get(&self, kind: Kind, digest: Digest) -> Result<Option<Vec<u8>>, String> {
        let told = |error: ureq::Error| format!("cannot read from the remote cache `{}`: {error}", self.address);
        let mut answer = self.agent.get(self.url(kind, digest)).call().map_err(told)?;
        match answer.status().as_u16() {
            200 => answer.body_mut().with_config().limit(MAX_BYTES).read_to_vec().map(Some).map_err(told),
            404 | 410 | 204 => Ok(None),
            status => Err(format!("cannot read from the remote cache `{}`: HTTP status {status}", self.address)),
        }
    }

    /// Keeps an entry.
    pub(super) fn put(&self, kind: Kind, digest: Digest, bytes: &[u8]) {
        if self.is_down() {
            return;
        }
        match self.agent.put(self.url(kind, digest)).send(bytes) {
            Ok(answer) if answer.status().is_success() => {}
            Ok(answer) => {
                let status = answer.status().as_u16();
                self.fail(format!("cannot write to the remote cache `{}`: HTTP status {status}", self.address));
            }
            Err(error) => self.fail(format!("cannot write to the remote cache `{}`: {error}", self.address)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Remote;

    #[test]
    fn addresses_are_those_of_http() {
        for address in ["http://localhost:8080", "http://cache.example/team/"] {
            assert!(Remote::new(address).is_ok(), "{address}");
        }
        for address in ["localhost:8080", "https://host", "grpc://host:9092", "http://", "http:// a"] {
            assert!(Remote::new(address).is_err(), "{address}");
        }
    }
}
