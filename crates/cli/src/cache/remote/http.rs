//! [`Http`]: Bazel's HTTP protocol.
//!
//! *In:* the name of an entry. *Out:* `GET` and `PUT` of `/ac/<digest>` and `/cas/<digest>`, as bazel-remote, nginx with WebDAV
//! and others serve them (<https://bazel.build/remote/caching>).

use super::{MAX_BYTES, Name, Server};
use std::time::Duration;

/// A server.
pub(super) struct Http {
    agent: ureq::Agent,
    address: String,
}

impl Http {
    /// The server at an address without a slash at its end.
    pub(super) fn new(address: &str, connect: Duration, answer: Duration) -> Self {
        let config = ureq::Agent::config_builder()
            .timeout_connect(Some(connect))
            .timeout_global(Some(answer))
            .http_status_as_error(false)
            .user_agent(concat!("glisten/", env!("CARGO_PKG_VERSION")));
        #[cfg(feature = "remote")]
        let config = config.tls_config(trusted());
        Self { agent: config.build().into(), address: address.to_owned() }
    }

    fn url(&self, name: Name) -> String {
        format!("{}/{}/{}", self.address, name.kind.word(), name.digest)
    }
}

/// Trusts the certificates of the machine, or those of `SSL_CERT_FILE`.
#[cfg(feature = "remote")]
fn trusted() -> ureq::tls::TlsConfig {
    let found = rustls_native_certs::load_native_certs().certs;
    let certificates = found.iter().map(|certificate| ureq::tls::Certificate::from_der(certificate).to_owned());
    let roots = ureq::tls::RootCerts::new_with_certs(&certificates.collect::<Vec<_>>());
    ureq::tls::TlsConfig::builder().root_certs(roots).build()
}

impl Server for Http {
    fn get(&self, name: Name) -> Result<Option<Vec<u8>>, String> {
        let mut answer = self.agent.get(self.url(name)).call().map_err(|error| error.to_string())?;
        match answer.status().as_u16() {
            200 => {
                let body = answer.body_mut().with_config().limit(MAX_BYTES as u64);
                body.read_to_vec().map(Some).map_err(|error| error.to_string())
            }
            404 | 410 | 204 => Ok(None),
            status => Err(format!("HTTP status {status}")),
        }
    }

    fn put(&self, name: Name, bytes: &[u8]) -> Result<(), String> {
        let answer = self.agent.put(self.url(name)).send(bytes).map_err(|error| error.to_string())?;
        let status = answer.status();
        if status.is_success() { Ok(()) } else { Err(format!("HTTP status {}", status.as_u16())) }
    }
}
