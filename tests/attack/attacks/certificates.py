"""Certificates that must not pass as a site, each with its own good key.

He can: own the authority's key but for the wrong purpose, another authority, or the keys of another
site of the same authority.
Must hold: neither site begins a session with any of them.
"""

from __future__ import annotations

import datetime
from collections.abc import Iterator

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID as Usage
from cryptography.x509.oid import NameOID

from client.attack import Attack, Verdict, learn_settings
from client.dtls import Identity
from client.programs import Bench
from client.session import Settings
from client.site import Patient, Surgeon

USAGE = {"surgeon": Usage.CLIENT_AUTH, "patient": Usage.SERVER_AUTH}
OTHER = {"surgeon": "patient", "patient": "surgeon"}
DAY = datetime.timedelta(days=1)


def _name(words: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, words)])


def _pem(key: ec.EllipticCurvePrivateKey) -> bytes:
    return key.private_bytes(
        serialization.Encoding.PEM,
        serialization.PrivateFormat.PKCS8,
        serialization.NoEncryption(),
    )


class Authority:
    def __init__(self, key, certificate: x509.Certificate) -> None:
        self.key, self.certificate = key, certificate

    @staticmethod
    def of(bench: Bench) -> Authority:
        folder = bench.keys / "authority"
        key = serialization.load_pem_private_key((folder / "key.pem").read_bytes(), None)
        pem = (folder / "certificate.pem").read_bytes()
        return Authority(key, x509.load_pem_x509_certificate(pem))

    @staticmethod
    def like(original: Authority) -> Authority:
        """Another authority with the same name."""
        key = ec.generate_private_key(ec.SECP256R1())
        name = original.certificate.subject
        now = datetime.datetime.utcnow()
        builder = x509.CertificateBuilder(name, name, key.public_key(), 1, now - DAY, now + DAY)
        builder = builder.add_extension(x509.BasicConstraints(True, None), True)
        return Authority(key, builder.sign(key, hashes.SHA256()))

    def issue(
        self,
        role: str,
        usages: list | None = None,
        uris: list[str] | None = None,
        authority: bool = False,
        begins: datetime.timedelta = -DAY,
        ends: datetime.timedelta = DAY,
        subject: str = "",
    ) -> Identity:
        key = ec.generate_private_key(ec.SECP256R1())
        now = datetime.datetime.utcnow()
        builder = x509.CertificateBuilder(
            self.certificate.subject, _name(subject or f"palp {role} site"), key.public_key(),
            x509.random_serial_number(), now + begins, now + ends,
        ).add_extension(x509.BasicConstraints(authority, None), True)  # fmt: skip
        usages = [USAGE[role]] if usages is None else usages
        if usages:
            builder = builder.add_extension(x509.ExtendedKeyUsage(usages), False)
        uris = [f"palp:{role}"] if uris is None else uris
        if uris:
            names = [x509.UniformResourceIdentifier(uri) for uri in uris]
            builder = builder.add_extension(x509.SubjectAlternativeName(names), False)
        signs = [True, *[False] * 4, authority, authority, False, False]
        builder = builder.add_extension(x509.KeyUsage(*signs), True)
        pem = builder.sign(self.key, hashes.SHA256()).public_bytes(serialization.Encoding.PEM)
        return Identity(pem, _pem(key))


def bad_ones(bench: Bench, role: str) -> Iterator[tuple[str, Identity | None]]:
    authority = Authority.of(bench)
    issue = authority.issue
    other = OTHER[role]
    yield "no certificate", None
    yield "no extended key usage", issue(role, usages=[])
    yield "any extended key usage", issue(role, usages=[Usage.ANY_EXTENDED_KEY_USAGE])
    yield "another usage (e-mail)", issue(role, usages=[Usage.EMAIL_PROTECTION])
    yield "a CA as a site", issue(role, authority=True)
    yield "the other role", issue(other)
    yield "the usage of the other role", issue(role, usages=[USAGE[other]])
    yield "the name of the other role", issue(role, uris=[f"palp:{other}"])
    yield "no name of a role", issue(role, uris=[])
    yield "a name that begins like it", issue(role, uris=[f"palp:{role}x"])
    yield "expired", issue(role, begins=-3 * DAY, ends=-2 * DAY)
    yield "not yet valid", issue(role, begins=2 * DAY, ends=3 * DAY)
    yield "another authority of the same name", Authority.like(authority).issue(role)
    folder = bench.keys / "authority"
    yield "the authority itself", Identity.of(folder)
    yield "a site below a site", _below_a_site(bench, role)


def _below_a_site(bench: Bench, role: str) -> Identity:
    """Issued by the other site's key, with that site's certificate in the chain."""
    site = bench.identity(OTHER[role])
    key = serialization.load_pem_private_key(site.key, None)
    certificate = x509.load_pem_x509_certificate(site.certificate)
    made = Authority(key, certificate).issue(role)
    return Identity(made.certificate, made.key, (site.certificate,))


def _passes_as_surgeon(bench, address, identity, settings: Settings, seconds=1.5) -> bool:
    """A host that has just failed begins one handshake a second."""
    with Surgeon(identity, address, settings) as surgeon:
        return surgeon.run(seconds, lambda: surgeon.established)


def _surgeons(bench: Bench, settings: Settings) -> list[str]:
    patient = bench.patient()
    address = patient.address()
    passed = [
        name
        for name, identity in bad_ones(bench, "surgeon")
        if _passes_as_surgeon(bench, address, identity, settings)
    ]
    if not _passes_as_surgeon(bench, address, bench.identity("surgeon"), settings, 5):
        passed.append("(the good one did not pass)")
    return [f"as surgeon {name}" for name in passed]


def _patients(bench: Bench) -> list[str]:
    passed = []
    for name, identity in bad_ones(bench, "patient"):
        if identity is None:
            continue  # No server of DTLS without a certificate.
        with Patient(identity) as patient:
            surgeon = bench.surgeon(patient.address)
            began = patient.run(3, lambda: patient.established or "certificate" in surgeon.log)
            if began and patient.established:
                passed.append(f"as patient {name}")
            surgeon.finish()
    return passed


def certificates(bench: Bench) -> Verdict:
    settings = learn_settings(bench)
    passed = _surgeons(bench, settings) + _patients(bench)
    return Verdict(f"29 bad certificates, passed: {', '.join(passed) or 'none'}", not passed)


def other_site(bench: Bench) -> Verdict:
    """The keys of another patient's site of the same authority answer for this address."""
    identity = Authority.of(bench).issue("patient", subject="stranger patient site")
    with Patient(identity) as patient:
        surgeon = bench.surgeon(patient.address)
        began = patient.run(4, lambda: patient.established)
    surgeon.finish()
    return Verdict(
        "another site's certificate " + ("passed" if began else "did not pass"), not began
    )


def _revocations(by: Authority, serials: list[int]) -> bytes:
    now = datetime.datetime.utcnow()
    builder = x509.CertificateRevocationListBuilder(by.certificate.subject, now - DAY, now + DAY)
    for serial in serials:
        one = x509.RevokedCertificateBuilder(serial, now - DAY).build()
        builder = builder.add_revoked_certificate(one)
    return builder.sign(by.key, hashes.SHA256()).public_bytes(serialization.Encoding.PEM)


def revoked_authority(bench: Bench) -> Verdict:
    """A good certificate below an authority in between, which the first authority has revoked."""
    settings = learn_settings(bench)
    first = Authority.like(Authority.of(bench))  # The original signs sites only.
    between = first.issue("surgeon", usages=[], uris=[], authority=True, subject="between")
    certificate = x509.load_pem_x509_certificate(between.certificate)
    second = Authority(serialization.load_pem_private_key(between.key, None), certificate)
    made = second.issue("surgeon")
    identity = Identity(made.certificate, made.key, (between.certificate,))
    # Whoever reads only the first list of the file must refuse what he cannot look up.
    lists = _revocations(second, []) + _revocations(first, [certificate.serial_number])
    site = first.issue("patient")
    for name, pem in {
        "authority": first.certificate.public_bytes(serialization.Encoding.PEM),
        "certificate": site.certificate,
        "key": site.key,
        "revoked": lists,
    }.items():
        (bench.keys / "patient" / f"{name}.pem").write_bytes(pem)
    patient = bench.patient()
    passed = _passes_as_surgeon(bench, patient.address(), identity, settings)
    honest = _passes_as_surgeon(bench, patient.address(), first.issue("surgeon"), settings, 5)
    return Verdict(
        f"a surgeon below a revoked authority {'passed' if passed else 'did not pass'}, an honest "
        f"one {'passed' if honest else 'did not pass'}",
        honest and not passed,
    )


ATTACKS = [
    Attack("revoked-authority", "below an authority that was revoked itself", revoked_authority),
    Attack("certificates", "15 kinds of certificates that name no site", certificates),
    Attack("other-site", "another site's certificate at the patient's address", other_site),
]
