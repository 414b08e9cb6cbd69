# Sourced by routers, after common.sh: two sites, each behind a router of its own, and a host that
# all can reach, in network namespaces.
#   s --- ns --- w --- np --- p      surgeon, its router, wide area, router, patient
#                |
#                r                   relay, and hub of a VPN
net=palp$$
near_router=198.51.100.1 far_router=198.51.100.2 public=198.51.100.9
surgeon_at=10.1.0.2 patient_at=10.2.0.2

inside() { # namespace command...
  local one=$1
  shift
  ip netns exec "$net-$one" "$@"
}
stop_all() { # what runs inside, not the shells that started it
  local one
  for one in s ns w np p r; do
    ip netns pids "$net-$one" 2>/dev/null | xargs -r kill 2>/dev/null
  done
  wait 2>/dev/null
  for one in s ns w np p r; do ip netns del "$net-$one" 2>/dev/null; done
}
cable() { # namespace its-end namespace its-end
  ip link add "$2" netns "$net-$1" type veth peer name "$4" netns "$net-$3"
}
set_address() { # namespace link address
  inside "$1" ip addr add "$3" dev "$2" && inside "$1" ip link set "$2" up
}
make_net() {
  local one
  for one in s ns w np p r; do
    ip netns add "$net-$one" 2>/dev/null && inside "$one" ip link set lo up || return 1
  done
  cable s s0 ns lan && cable p p0 np lan && cable ns wan w near && cable np wan w far &&
    cable r r0 w public && inside w ip link add br0 type bridge || return 1
  for one in near far public; do
    inside w ip link set "$one" master br0 && inside w ip link set "$one" up || return 1
  done
  inside w ip link set br0 up
  set_address s s0 $surgeon_at/24 && set_address ns lan 10.1.0.1/24 &&
    set_address p p0 $patient_at/24 && set_address np lan 10.2.0.1/24 &&
    set_address ns wan $near_router/24 && set_address np wan $far_router/24 &&
    set_address r r0 $public/24 || return 1
  inside s ip route add default via 10.1.0.1
  inside p ip route add default via 10.2.0.1
  # A site without a router of its own has a public address: all know the way there.
  for one in ns r; do inside "$one" ip route add 10.2.0.0/24 via $far_router; done
  for one in np r; do inside "$one" ip route add 10.1.0.0/24 via $near_router; done
  for one in ns np; do inside "$one" sh -c 'echo 1 >/proc/sys/net/ipv4/ip_forward'; done
}

# What a router does: none, masquerade (the inside port is kept if it can be), random (another
# outside port for every destination), forwarded (masquerade, and one port leads to the patient).
# What nobody inside asked for is dropped. Flows that exist keep their old way: take new ports.
set_router() { # namespace kind port
  inside "$1" nft flush ruleset || return 1
  local flags="" open="" leads=""
  case $2 in
    none) return 0 ;;
    random) flags=random ;;
    forwarded)
      open="iifname \"wan\" udp dport $3 accept"
      leads="chain arriving {
        type nat hook prerouting priority dstnat
        iifname \"wan\" udp dport $3 dnat to $patient_at
      }"
      ;;
  esac
  inside "$1" nft -f - <<RULES
table ip address {
  chain leaving {
    type nat hook postrouting priority srcnat
    oifname "wan" masquerade $flags
  }
  $leads
}
table ip filter {
  chain router {
    type filter hook input priority 0
    iifname "wan" ct state established,related accept
    iifname "wan" drop
  }
  chain transit {
    type filter hook forward priority 0
    iifname "wan" ct state established,related accept
    $open
    iifname "wan" drop
  }
}
RULES
}

vpn_of() { # namespace: the name of its WireGuard device; what serves it is known by name alone
  echo "wg${1}$$"
}
add_vpn() { # namespace address
  local device
  device=$(vpn_of "$1")
  if ! inside "$1" ip link add "$device" type wireguard 2>/dev/null; then
    command -v wireguard-go >/dev/null && [ -c /dev/net/tun ] || return 1
    inside "$1" env LOG_LEVEL=error wireguard-go -f "$device" >"$work/vpn-$1.log" 2>&1 &
    for _ in $(seq 1 100); do
      inside "$1" wg show "$device" >/dev/null 2>&1 && break
      sleep 0.05
    done
  fi
  (umask 077 && wg genkey >"$work/vpn-$1.key") &&
    inside "$1" ip addr add "$2/24" dev "$device" &&
    inside "$1" ip link set "$device" mtu 1420 up
}
configure_vpn() { # namespace block-of-the-guide sed-script
  awk -v block="$2" '/^```/ { on = ($0 == "```ini " block); next } on && !/^Address/' \
    "$root/docs/two-sites.md" | sed "$3" >"$work/vpn-$1.conf"
  [ -s "$work/vpn-$1.conf" ] && inside "$1" wg setconf "$(vpn_of "$1")" "$work/vpn-$1.conf"
}
private_key() { sed 's,[&/],\\&,g' "$work/vpn-$1.key"; }
public_key() { wg pubkey <"$work/vpn-$1.key" | sed 's,[&/],\\&,g'; }
make_vpn() { # as the guide has it
  add_vpn r 10.66.0.1 && add_vpn s 10.66.0.3 && add_vpn p 10.66.0.2 || return 1
  inside r sh -c 'echo 1 >/proc/sys/net/ipv4/ip_forward'
  configure_vpn r hub "s/PRIVATE_KEY_OF_HUB/$(private_key r)/
    s/PUBLIC_KEY_OF_PATIENT/$(public_key p)/; s/PUBLIC_KEY_OF_SURGEON/$(public_key s)/"
}
# Both sites anew, from other ports: no router knows them. They show themselves each second.
call_vpn() { # port
  local one
  for one in s p; do
    configure_vpn $one site "s/PRIVATE_KEY_OF_SITE/$(private_key $one)/
      s/PUBLIC_KEY_OF_HUB/$(public_key r)/; s/HUB:/$public:/; s/^\(Persist.*\) 20/\1 1/" &&
      inside "$one" wg set "$(vpn_of $one)" listen-port "$1" || return 1
  done
}
