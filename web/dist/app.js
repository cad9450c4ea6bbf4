"use strict";(()=>{var re,fu,Yi,Pn,ji,pl,pu,cl,du,Ki,qi,Gd,br=Symbol.for("pv"),dl={},ml=[],Bd=/^m(i|n|o|s|text|space)$/,Zi=Array.isArray,Ji=ml.
slice,Jn=Object.assign;function Zn(e){e&&e.parentNode&&e.remove()}function mu(e,t,n){var o,r,l,a={},c=arguments.length;for(l in t)
l=="key"?o=t[l]:l=="ref"&&typeof e!="function"?r=t[l]:a[l]=t[l];return c>2&&(a.children=c>3?Ji.call(arguments,2):n),_r(e,
a,o,r,null)}function _r(e,t,n,o,r){var l={type:e,props:t,key:n,ref:o,__k:null,__:null,__b:0,__e:null,__c:null,constructor:br,__v:r||
++fu,__i:-1,__u:0};return!r&&re.vnode&&re.vnode(l),l}function te(e){return e.children}function Lo(e,t){this.props=e,this.context=t,this.__g=0}function On(e,t){if(t==null)return e.
__&&On(e.__,e.__i+1);for(var n;t<e.__k.length;t++)if((n=e.__k[t])&&n.__e)return n.__e;return typeof e.type!="function"||
e.props.__P?null:On(e)}function jd(e){var t,n=e.__v,o=n.__e,r=[],l=[],a=e.__P;a&&((t=Jn({constructor:br},n)).__v=n.__v+1,
re.vnode&&re.vnode(t),Xi(a,t,n,e.__n,a.namespaceURI,32&n.__u?[o]:null,r,o||On(n),32&n.__u,l),t.__v=n.__v,t.__.__k[t.__i]=
t,xu(r,t,l),n.__=n.__e=null,t.__e!=o&&hu(t))}function hu(e){if((e=e.__)&&e.__c&&!e.props.__P)return e.__e=null,e.__k.some(
function(t){return t&&(e.__e=t.__e)}),hu(e)}function uu(e){(8&e.__g||(e.__g|=8,Pn.push(e),pl++))&&ji==re.debounceRendering||
((ji=re.debounceRendering)||queueMicrotask)(gu)}function gu(){try{for(var e,t=1;Pn.length;)Pn.length>t&&Pn.sort(pu),e=Pn.
shift(),t=Pn.length,8&e.__g&&jd(e)}finally{(pl=Pn.length)&&(ji||queueMicrotask)(gu)}}function vu(e,t,n,o,r,l,a,c,d,m,g){
var _,x,v,k,N,E,F=o.__k||ml,w=t.length;for(d=qd(n,t,F,d,w),_=0;_<w;_++)(v=n.__k[_])!=null&&(x=~v.__i&&F[v.__i]||dl,v.__i=
_,E=Xi(e,v,x,r,l,a,c,d,m,g),k=v.__e,(x.ref!=v.ref||8&x.__u)&&(x.ref&&Qi(x.ref,null,v,x),v.ref&&g.push(v.ref,v.__c||k,v)),
N=N||k,4&v.__u?(d=_u(v,d,e,!x.__v),x.__e&&(x.__e=null)):typeof v.type=="function"&&E!==void 0?d=E:k&&(d=k.nextSibling),v.
__u&=-21);return n.__e=N,d}function qd(e,t,n,o,r){var l,a,c,d,m,g,_,x,v,k=n.length,N=k,E=0,F=0,w=e.__k=Array(r);for(l=0;l<
r;l++)(a=t[l])!=null&&typeof a!="boolean"&&typeof a!="function"?(typeof a!="object"||a.constructor===String?a=w[l]=_r(null,
a):Zi(a)?a=w[l]=_r(te,{children:a}):a.constructor===br&&a.__b?a=w[l]=_r(a.type,a.props,a.key,a.ref,a.__v):w[l]=a,d=l+E,a.
__=e,a.__b=e.__b+1,c=null,~(m=a.__i=Yd(a,n,d,N))&&(N--,(c=n[m])&&(c.__u|=2)),c&&c.__v?(a.__u|=16,m==d-1?E--:m==d+1?E++:m!=
d&&(m>d?E--:E++,F=1)):(~m||(r>k?E--:r<k&&E++),typeof a.type!="function"&&(a.__u|=4))):w[l]=null;if(F){for(g=[],_=[],l=0;l<
r;l++)if((a=w[l])&&16&a.__u){for(E=0,x=g.length;E<x;)g[v=E+x>>1]<a.__i?E=v+1:x=v;g[E]=a.__i,_[l]=E+1}for(E=g.length;l--;)
_[l]&&(_[l]==E?E--:w[l].__u|=4)}if(N)for(l=0;l<k;l++)!(c=n[l])||2&c.__u||(c.__e==o&&(o=On(c)),es(c,c));return o}function _u(e,t,n,o){
var r,l,a,c;if(typeof e.type=="function"){if(e.props.__P)return t;if(r=e.__k)for(l=0;l<r.length;l++)r[l]&&(r[l].__=e,t=_u(
r[l],t,n,!1));return t}for(t&&!t.parentNode&&(t=On(e))&&!t.parentNode&&(t=null),a=e.__e,c=t;c&&c.nodeType==8;)c=c.nextSibling;
for(a!=c&&(!o&&n.moveBefore&&a.parentNode?n.moveBefore(a,t):n.insertBefore(a,t||null)),t=a;(t=t&&t.nextSibling)&&t.nodeType==
8&&!t.data.startsWith("$s"););return t}function Yd(e,t,n,o){var r,l=e.key,a=e.type,c=t[n],d=c&&!(2&c.__u);if(c===null&&l==null||d&&l==c.key&&a==c.type)return n;
if(o>(d?1:0)){for(r=n-1;r>=0;r--)if((c=t[r])&&!(2&c.__u)&&l==c.key&&a==c.type)return r;for(r=n+1;r<t.length;r++)if((c=t[r])&&
!(2&c.__u)&&l==c.key&&a==c.type)return r}return-1}function cu(e,t,n){n==null&&(n=""),t[0]=="-"?e.setProperty(t,n):e[t]=n}
function ul(e,t,n,o,r){var l,a;if(t=="style")if(typeof n=="string")e.style.cssText=n;else{if(typeof o=="string"&&(e.style.
cssText=o=""),o)for(t in o)n&&t in n||cu(e.style,t);if(n)for(t in n)o&&n[t]==o[t]||cu(e.style,t,n[t])}else if(t[0]=="o"&&
t[1]=="n")typeof n!="function"&&(n=null),typeof o!="function"&&(o=null),(e.__e||(e.__e={}))[t]=n,n&&o||(a=qi[t]||(qi[t]=
Kd(t)),(e.__a||(e.__a={}))[t]=Ki,l=t!=(t=t.replace(du,"$1")),(t=t.slice(2))[0]<"a"&&(t=t.toLowerCase()),n?e.addEventListener(
t,a,l):e.removeEventListener(t,a,l));else{if(r=="http://www.w3.org/2000/svg")t=t.replace(/xlink(H|:h)/,"h").replace(/sName$/,
"s");else if(t!="width"&&t!="height"&&t!="href"&&t!="list"&&t!="form"&&t!="tabIndex"&&t!="download"&&t!="rowSpan"&&t!="c\
olSpan"&&t!="role"&&t!="popover"&&t in e)try{return void(e[t]=n??"")}catch{}if(typeof n=="function")return;n==null||n===
!1&&t[4]!="-"?e.removeAttribute(t):e.setAttribute(t,t=="popover"&&n==1?"":n)}}function Kd(e){return function(t){var n=this.
__e;if(n){if(n=n[e],t[cl]==null)t[cl]=Ki++;else if(t[cl]<this.__a[e])return;return n(re.event?re.event(t):t)}}}function Xi(e,t,n,o,r,l,a,c,d,m){
var g,_,x,v,k,N,E,F,w,P,S,K,$,Z,G,X,W,A,B=t.type;if(t.constructor!==br)return null;128&n.__u&&(d=32&n.__u,g=n.__c.__z)&&
(t.__u|=d,_=l=[],g.nodeType==8?c=fl(g,l):l.push(g),c=l[0]||c),(g=re.__b)&&g(t);e:if(typeof B=="function"){x=a.length;try{
if(F=t.props,w=(g=B.prototype)&&g.render,P=(g=B.contextType)&&o[g.__c],S=g?P?P.props.value:g.__:o,(v=n.__c)?(t.__c=v,2&v.
__g&&(v.__g|=1)):(w?t.__c=v=new B(F,S):(t.__c=v=new Lo(F,S),v.constructor=B,v.render=Jd),P&&P.sub(v),v.state||(v.state={}),
v.__n=o,v.__g|=8,v.__h=[],v.__k=[]),w&&(v.__s||(v.__s=v.state),B.getDerivedStateFromProps&&(v.__s==v.state&&(v.__s=Jn({},
v.__s)),Jn(v.__s,B.getDerivedStateFromProps(F,v.__s)))),k=v.props,N=v.state,v.__v=t,n.__c){if(F!==k&&w&&!B.getDerivedStateFromProps&&
v.componentWillReceiveProps&&v.componentWillReceiveProps(F,S),t.__v==n.__v&&!(8&v.__g)||!(4&v.__g)&&v.shouldComponentUpdate&&
v.shouldComponentUpdate(F,v.__s,S)===!1){t.__v!=n.__v&&(v.props=F,v.state=v.__s,v.__g&=-9),t.__e=n.__e,t.__k=n.__k,t.__k.
some(function(C){C&&(C.__=t)}),ml.push.apply(v.__h,v.__k),v.__k=[],v.__h.length&&a.push(v),c=On(n);break e}v.componentWillUpdate&&
v.componentWillUpdate(F,v.__s,S),w&&v.componentDidUpdate&&v.__h.push(function(){v.componentDidUpdate(k,N,E)})}else w&&!B.
getDerivedStateFromProps&&v.componentWillMount&&v.componentWillMount(),w&&v.componentDidMount&&v.__h.push(v.componentDidMount);
v.context=S,v.props=F,v.__P=e,v.__g&=-5,K=re.__r,$=w?25:0;do v.__g&=-9,K&&K(t),g=v.render(v.props,v.state=v.__s,v.context);while(8&
v.__g&&++$<25);w&&(ml.push.apply(v.__h,v.__k),v.__k=[]),v.state=v.__s,v.getChildContext&&(o=Jn({},o,v.getChildContext())),
w&&n.__c&&v.getSnapshotBeforeUpdate&&(E=v.getSnapshotBeforeUpdate(k,N)),Z=g&&g.type===te&&g.key==null?g.props.children:g,
F.__P&&(g=c,r=(e=F.__P).namespaceURI,d=l=null,n.props&&n.props.__P!=e&&(n.__k.some(function(C){C&&es(C,C)}),n.__k=null),
c=n.__k?On(n,0):null),c=vu(e,Zi(Z)?Z:[Z],t,n,o,r,l,a,c,d,m),F.__P&&(t.__e=null,c=g),t.__u&=-161,_&&_.some(Zn),v.__h.length&&
a.push(v),1&v.__g&&(v.__g&=-4)}catch(C){if(a.length=x,t.__v=null,d||l)if(C&&C.then){if(t.__u|=128|d,l){for(~(W=l.indexOf(
c||void 0))||(W=l.length);(A=l[W-1])&&A.nodeType==8;)W--;for(;W<l.length;W++)if(A=l[W])if(l[W]=null,G){if(A==X)break}else{
if(A.nodeType!=8)break;A.data.startsWith("$s")&&(X=fl(G=A))}}if(!G){for(;c&&c.nodeType==8&&c.nextSibling;)c=c.nextSibling;
G=c}(g=fl(G=t.__c.__z||(t.__c.__z=G)))?(t.__e=G,c=g):t.__e=c,c=c&&c.nextSibling}else l&&l.some(Zn);else t.__e=n.__e;t.__k||
(t.__k=n.__k||[]),C&&C.then||bu(t),re.__e(C,t,n)}}else c=t.__e=Zd(n.__e,t,n,o,r,l,a,d,m,e);return(g=re.diffed)&&g(t),c}function fl(e,t){
if(e&&e.nodeType==8&&e.data.startsWith("$s"))for(var n=1;e=e.nextSibling;){if(e.nodeType==8){if(e.data.startsWith("$s"))
n++;else if(e.data.startsWith("/$s")&&!--n)return e}t&&t.push(e)}}function bu(e){e&&(e.__c&&(e.__c.__g|=4),e.__k&&e.__k.
some(bu))}function xu(e,t,n){for(var o=0;o<n.length;)Qi(n[o++],n[o++],n[o++]);re.__c&&re.__c(t,e),e.some(function(r){try{
e=r.__h,r.__h=[],e.some(function(l){l.call(r)})}catch(l){re.__e(l,r.__v)}})}function Zd(e,t,n,o,r,l,a,c,d,m){var g,_,x,v,
k,N,E,F,w=n.props||dl,P=t.props,S=t.type;if(S=="svg"?r="http://www.w3.org/2000/svg":S=="math"?r="http://www.w3.org/1998/\
Math/MathML":r||(r="http://www.w3.org/1999/xhtml"),l){for(g=0;g<l.length;g++)if((k=l[g])&&(S?k.localName==S:k.nodeType==
3)){e=k,l[g]=null;break}}if(!e){if(F=m.ownerDocument||document,!S)return F.createTextNode(P);e=F.createElementNS(r,S,P.is?
P:m),c&&(re.__m&&re.__m(t,l),c=!1),l=null}if(S){if(m=S=="template"&&e.content||e,l=S=="textarea"&&P.defaultValue!=null?null:
l&&Ji.call(m.childNodes),!c&&l)for(w={},g=0;g<e.attributes.length;g++)w[(k=e.attributes[g]).name]=k.value;for(g in w)k=w[g],
g=="dangerouslySetInnerHTML"?x=k:g=="children"||g in P||g=="value"&&"defaultValue"in P||g=="checked"&&"defaultChecked"in
P||ul(e,g,null,k,r);for(g in P)k=P[g],g=="children"?v=k:g=="dangerouslySetInnerHTML"?_=k:g=="value"?N=k:g=="checked"?E=k:
c&&typeof k!="function"||w[g]===k||ul(e,g,k,w[g],r);_?(c||x&&(_.__html==x.__html||_.__html==e.innerHTML)||(e.innerHTML=_.
__html),t.__k=[]):(x&&(e.textContent=""),(S=="foreignObject"||r=="http://www.w3.org/1998/Math/MathML"&&Bd.test(S))&&(r="\
http://www.w3.org/1999/xhtml"),vu(m,Zi(v)?v:[v],t,n,o,r,l,a,l?l[0]:n.__k&&On(n,0),c,d),l&&l.some(Zn)),c&&S!="textarea"||
(g="value",S=="progress"&&N==null?e.removeAttribute(g):N==null||N===e[g]&&(S!="progress"||N)||ul(e,g,N,w[g],r),g="checke\
d",E!=null&&E!=e[g]&&ul(e,g,E,w[g],r))}else w===P||c&&e.data==P||(e.data=P);return e}function Qi(e,t,n,o){try{typeof e==
"function"?t?t.__x=e(t)||1:o&&(o=o.__c||o.__e)&&(t=o.__x)&&(o.__x=null,typeof t=="function"?t():e(null)):e.current=t}catch(r){
re.__e(r,n)}}function es(e,t,n){var o,r,l,a;if(re.unmount&&re.unmount(e),!(o=e.ref)||o.current&&o.current!=e.__e||Qi(o,null,
t,e),o=e.__c){if(o.componentWillUnmount)try{o.componentWillUnmount()}catch(c){re.__e(c,t)}o.__P=o.__n=null}if(o=e.__k)for(a=
0;a<o.length;a++)o[a]&&es(o[a],t,typeof e.type!="function"||n&&!e.props.__P);!n&&(o=e.__c)&&(o=o.__z)&&(r=fl(o,l=[]))&&(o==
e.__e&&l.some(Zn),Zn(r),Zn(o)),n||Zn(e.__e),e.__e=e.__c=e.__=null}function Jd(e,t,n){return this.constructor(e,n)}function wu(e,t){
var n,o,r,l;re.__&&re.__(e,t),t.nodeType==9&&(t=t.documentElement),o=(n=e&&32&e.__u)?null:t.__k,t.__k=_r(te,{children:[e]}),
r=[],l=[],Xi(t,t.__k,o||dl,dl,t.namespaceURI,o?null:t.firstChild?Ji.call(t.childNodes):null,r,o?o.__e:t.firstChild,n,l),
xu(r,t.__k,l),t.__k.props.children=null}re={__e:function(e,t,n,o){for(var r,l,a;t=t.__;)if((r=t.__c)&&!(1&r.__g)){r.__g|=4;try{if((a=(l=r.constructor)&&l.getDerivedStateFromError)&&
r.setState(l.getDerivedStateFromError(e)),r.componentDidCatch&&(r.componentDidCatch(e,o||{}),a=1),a&&8&r.__g)return void(r.
__g|=2)}catch(c){e=c}}throw pl=0,e}},fu=0,Yi=function(e){return e!=null&&e.constructor===br},Lo.prototype.setState=function(e,t){
var n=this.__s;n&&n!=this.state||(n=this.__s=Jn({},this.state)),typeof e=="function"&&(e=e(Jn({},n),this.props)),e&&(Jn(
n,e),this.__v&&(t&&this.__k.push(t),uu(this)))},Lo.prototype.forceUpdate=function(e){this.__v&&(this.__g|=4,e&&this.__h.
push(e),uu(this))},Lo.prototype.render=te,Pn=[],pl=0,pu=function(e,t){return e.__v.__b-t.__v.__b},cl=Symbol(),du=/(PointerCapture)$|Capture$/i,
Ki=0,qi={},Gd=0;var $o,De,ts,yu,ns=Object.is,hl=0,Ou=[],os=[],Fe=re,Su=Fe.__b,ku=Fe.__r,Mu=Fe.diffed,Tu=Fe.__c,Au=Fe.unmount,Eu=Fe.__;function gl(e,t){
Fe.__h&&Fe.__h(De,e,hl||t),hl=0;var n=De.__H||(De.__H={__:[],__h:[]});return e>=n.__.length&&n.__.push({}),n.__[e]}function Fu(e){
return hl=1,Xd(Cu,e)}function Xd(e,t,n){var o=gl($o++,2);if(o.t=e,!o.__c&&(o.__=[n?n(t):Cu(void 0,t),function(l){var a=(o.
__N||o.__)[0],c=o.t(a,l);ns(a,c)||(o.__N=[c,o.__[1]],o.__c.setState({}))}],o.__c=De,!De.__f)){De.__f=!0;var r=De.shouldComponentUpdate;
De.shouldComponentUpdate=function(l,a,c){var d=this.__H;if(!d)return!0;var m=!1,g=this.props!=l;if(d.__.some(function(x){
x.__N&&(m=!0,ns(x.__[0],x.__N[0])||(g=!0))}),r){var _=r.call(this,l,a,c);return m?_||g:_}return!m||g}}return o.__}function Qe(e,t){
var n=gl($o++,3);!Fe.__s&&ls(n.__H,t)&&(n.__P=!0,n.__=e,n.u=t,De.__H.__h.push(n))}function Ro(e,t){var n=gl($o++,4);!Fe.
__s&&ls(n.__H,t)&&(n.__P=!1,n.__=e,n.u=t,De.__h.push(n))}function $t(e){return hl=5,vl(function(){return{current:e}},[])}function vl(e,t){var n=gl($o++,7);return ls(n.__H,t)&&(n.__=e(),n.__H=t),n.__}function Qd(){var e;do{for(;e=os.shift();)try{xr(e)}catch(n){Fe.__e(n,{__:(e=e.__P)&&e.__v})}for(;e=Ou.shift();){var t=e.
__H;if(e.__P&&t)try{t.__h.some(xr),t.__h.some(rs),t.__h=[]}catch(n){t.__h=[],Fe.__e(n,e.__v)}}}while(os.length)}Fe.__b=function(e){
De=null,Su&&Su(e)},Fe.__=function(e,t){e&&t.__k&&t.__k.__m&&(e.__m=t.__k.__m),Eu&&Eu(e,t)},Fe.__r=function(e){ku&&ku(e),
$o=0;var t=(De=e.__c).__H;t&&(ts==De?De.__h=[]:(t.__h.some(xr),t.__h.some(rs),$o=0),t.__h=[],t.__.some(function(n){n.__N&&
(n.__=n.__N),n.u=n.__N=void 0})),ts=De},Fe.diffed=function(e){Mu&&Mu(e);var t=e.__c;t&&t.__H&&(t.__H.__h.length&&Pu(Ou.push(
t)),t.__H.__.some(function(n){n.u&&(n.__H=n.u)})),ts=De=null},Fe.__c=function(e,t){t.some(function(n){try{n.__h.some(xr),
n.__h=n.__h.filter(function(o){return!o.__||rs(o)})}catch(o){n.__h=[function(){throw o}]}}),Tu&&Tu(e,t)},Fe.unmount=function(e){
Au&&Au(e);var t,n,o=e.__c;o&&o.__H&&(o.__H.__.some(function(r){try{if(r.__P&&r.__c){if(n===void 0){for(n=e.__;n&&(!n.__c||
!n.__c.__P);)n=n.__;n=n&&n.__c}r.__P=n,Pu(os.push(r))}else xr(r)}catch(l){t=l}}),o.__H=void 0,t&&Fe.__e(t,o.__v))};var Nu=typeof requestAnimationFrame==
"function";function em(e){var t,n=function(){clearTimeout(o),Nu&&cancelAnimationFrame(t),setTimeout(e)},o=setTimeout(n,35);
Nu&&(t=requestAnimationFrame(n))}function Pu(e){e!=1&&yu==Fe.requestAnimationFrame||((yu=Fe.requestAnimationFrame)||em)(
Qd)}function xr(e){var t=De,n=e.__c;typeof n=="function"&&(e.__c=void 0,n()),De=t}function rs(e){var t=De;e.__c=e.__(),De=
t}function ls(e,t){return!e||e.length!=t.length||t.some(function(n,o){return!ns(n,e[o])})}function Cu(e,t){return typeof t==
"function"?t(e):t}var tm=Symbol.for("preact-signals");function wl(){if(gn>1)gn--;else{var e,t=!1;for((function(){var r=bl;for(bl=void 0;r!==
void 0;){var l=r.S;if(l.v===r.v)for(var a=l.t;a!==void 0;a=a.x)a.i===r.i&&(a.i=l.i);r=r.o}})();yr!==void 0;){var n=yr;for(yr=
void 0,_l++;n!==void 0;){var o=n.u;if(n.u=void 0,n.f&=-3,!(8&n.f)&&Lu(n))try{n.c()}catch(r){t||(e=r,t=!0)}n=o}}if(_l=0,gn--,
t)throw e}}function un(e){if(gn>0)return e();is=++nm,gn++;try{return e()}finally{wl()}}var wr,Ae=void 0;function Sr(e){var t=Ae,
n=wr;Ae=void 0,wr=void 0;try{return e()}finally{Ae=t,wr=n}}var yr=void 0,gn=0,_l=0,nm=0,is=0,bl=void 0,xl=0;function Du(e){
if(Ae!==void 0){var t=e.n;if(t===void 0||t.t!==Ae)return t={i:0,S:e,p:Ae.s,n:void 0,t:Ae,e:void 0,x:void 0,r:t},Ae.s!==void 0&&
(Ae.s.n=t),Ae.s=t,e.n=t,32&Ae.f&&e.S(t),t;if(t.i===-1)return t.i=0,t.n!==void 0&&(t.n.p=t.p,t.p!==void 0&&(t.p.n=t.n),t.
p=Ae.s,t.n=void 0,Ae.s.n=t,Ae.s=t),t}}function ze(e,t){this.v=e,this.i=0,this.n=void 0,this.t=void 0,this.l=0,this.W=t?.
watched,this.Z=t?.unwatched,this.name=t?.name}ze.prototype.brand=tm;ze.prototype.h=function(){return!0};ze.prototype.S=function(e){
var t=this,n=this.t;n!==e&&e.e===void 0&&(e.x=n,this.t=e,n!==void 0?n.e=e:Sr(function(){var o;(o=t.W)==null||o.call(t)}))};
ze.prototype.U=function(e){var t=this;if(this.t!==void 0){var n=e.e,o=e.x;n!==void 0&&(n.x=o,e.e=void 0),o!==void 0&&(o.
e=n,e.x=void 0),e===this.t&&(this.t=o,o===void 0&&Sr(function(){var r;(r=t.Z)==null||r.call(t)}))}};ze.prototype.subscribe=
function(e){var t=this;return Le(function(){var n=t.value;Sr(function(){return e(n)})},{name:"sub"})};ze.prototype.valueOf=
function(){return this.value};ze.prototype.toString=function(){return this.value+""};ze.prototype.toJSON=function(){return this.
value};ze.prototype.peek=function(){var e=this;return Sr(function(){return e.value})};Object.defineProperty(ze.prototype,
"value",{get:function(){var e=Du(this);return e!==void 0&&(e.i=this.i),this.v},set:function(e){if(e!==this.v){if(_l>100)
throw new Error("Cycle detected");(function(n){gn!==0&&_l===0&&n.l!==is&&(n.l=is,bl={S:n,v:n.v,i:n.i,o:bl})})(this),this.
v=e,this.i++,xl++,gn++;try{for(var t=this.t;t!==void 0;t=t.x)t.t.N()}finally{wl()}}}});function I(e,t){return new ze(e,t)}
function Lu(e){for(var t=e.s;t!==void 0;t=t.n)if(t.S.i!==t.i||!t.S.h()||t.S.i!==t.i)return!0;return!1}function $u(e){for(var t=e.
s;t!==void 0;t=t.n){var n=t.S.n;if(n!==void 0&&(t.r=n),t.S.n=t,t.i=-1,t.n===void 0){e.s=t;break}}}function Ru(e){for(var t=e.
s,n=void 0;t!==void 0;){var o=t.p;t.i===-1?(t.S.U(t),o!==void 0&&(o.n=t.n),t.n!==void 0&&(t.n.p=o)):n=t,t.S.n=t.r,t.r!==
void 0&&(t.r=void 0),t=o}e.s=n}function Xn(e,t){ze.call(this,void 0,t),this.x=e,this.s=void 0,this.g=xl-1,this.f=4}Xn.prototype=
new ze;Xn.prototype.h=function(){if(this.f&=-3,1&this.f)return!1;if((36&this.f)==32||(this.f&=-5,this.g===xl))return!0;if(this.
g=xl,this.f|=1,this.i>0&&!Lu(this))return this.f&=-2,!0;var e=Ae;try{$u(this),Ae=this;var t=this.x();(16&this.f||this.v!==
t||this.i===0)&&(this.v=t,this.f&=-17,this.i++)}catch(n){this.v=n,this.f|=16,this.i++}return Ae=e,Ru(this),this.f&=-2,!0};
Xn.prototype.S=function(e){if(this.t===void 0){this.f|=36;for(var t=this.s;t!==void 0;t=t.n)t.S.S(t)}ze.prototype.S.call(
this,e)};Xn.prototype.U=function(e){if(this.t!==void 0&&(ze.prototype.U.call(this,e),this.t===void 0)){this.f&=-33;for(var t=this.
s;t!==void 0;t=t.n)t.S.U(t)}};Xn.prototype.N=function(){if(!(2&this.f)){this.f|=6;for(var e=this.t;e!==void 0;e=e.x)e.t.
N()}};Object.defineProperty(Xn.prototype,"value",{get:function(){if(1&this.f)throw new Error("Cycle detected");var e=Du(
this);if(this.h(),e!==void 0&&(e.i=this.i),16&this.f)throw this.v;return this.v}});function mt(e,t){return new Xn(e,t)}function Iu(e){
var t=e.j;if(e.j=void 0,typeof t=="function"){gn++;var n=Ae;Ae=void 0;try{t()}catch(o){throw e.f&=-2,e.f|=8,ss(e),o}finally{
Ae=n,wl()}}}function ss(e){for(var t=e.s;t!==void 0;t=t.n)t.S.U(t);e.x=void 0,e.s=void 0,Iu(e)}function om(e){if(Ae!==this)
throw new Error("Out-of-order effect");Ru(this),Ae=e,this.f&=-2;try{8&this.f&&ss(this)}finally{wl()}}function Io(e,t){this.
x=e,this.j=void 0,this.s=void 0,this.u=void 0,this.f=32,this.name=t?.name,wr&&wr.push(this)}Io.prototype.c=function(){var e=this.
S();try{if(8&this.f||this.x===void 0)return;var t=this.x();typeof t=="function"&&(this.j=t)}finally{e()}};Io.prototype.S=
function(){if(1&this.f)throw new Error("Cycle detected");this.f|=1,this.f&=-9,Iu(this),$u(this),gn++;var e=Ae;return Ae=
this,om.bind(this,e)};Io.prototype.N=function(){2&this.f||(this.f|=2,this.u=yr,yr=this)};Io.prototype.d=function(){this.
f|=8,1&this.f||ss(this)};Io.prototype.dispose=function(){this.d()};function Le(e,t){var n=new Io(e,t);try{n.c()}catch(r){
throw n.d(),r}var o=n.d.bind(n);return o[Symbol.dispose]=o,o}var Vu,Sl,yl,rm=typeof window<"u"&&!!window.__PREACT_SIGNALS_DEVTOOLS__;var zu=[];Le(function(){Vu=this.N})();function Vo(e,t){re[e]=t.bind(null,re[e]||function(){})}function kr(e){if(yl){var t=yl;
yl=void 0,t()}yl=e&&e.S()}function Hu(e){var t=this,n=e.data,o=im(n);o.name="ReactiveDom",o.value=n;var r=vl(function(){
for(var c=t,d=t.__v;d=d.__;)if(d.__c){d.__c.__$f|=4;break}var m=mt(function(){var v=o.value.value;return v===0?0:v===!0?
"":v||""}),g=mt(function(){return!Array.isArray(m.value)&&!Yi(m.value)}),_=Le(function(){if(this.N=Uu,g.value){var v=m.value;
c.__v&&c.__v.__e&&c.__v.__e.nodeType===3&&(c.__v.__e.data=v)}}),x=t.__$u.d;return t.__$u.d=function(){_(),x.call(this)},
[g,m]},[]),l=r[0],a=r[1];return l.value?a.peek():a.value}Hu.displayName="ReactiveTextNode";Object.defineProperties(ze.prototype,
{constructor:{configurable:!0,value:mu(te,null).constructor},type:{configurable:!0,value:Hu},props:{configurable:!0,get:function(){
var e=this;return{data:{get value(){return e.value}}}}},__b:{configurable:!0,value:1}});Vo("__b",function(e,t){if(kr(),Sl=
void 0,typeof t.type=="string"){var n,o=t.props;for(var r in o)if(r!=="children"){var l=o[r];l instanceof ze&&(n||(t.__np=
n={}),n[r]=l,o[r]=l.peek())}}e(t)});Vo("__r",function(e,t){if(e(t),t.type!==te){kr();var n,o=t.__c;o&&(o.__$f&=-2,(n=o.__$u)===
void 0&&(o.__$u=n=(function(r,l){var a;return Le(function(){a=this},{name:l}),a.c=r,a})((function(r){return function(){var l;
rm&&((l=this.y)==null||l.call(this)),r.__$f|=1,r.setState({})}})(o),typeof t.type=="function"?t.type.displayName||t.type.
name:""))),Sl=o,kr(n)}});Vo("__e",function(e,t,n,o){kr(),Sl=void 0,e(t,n,o)});Vo("diffed",function(e,t){kr(),Sl=void 0;var n;
if(typeof t.type=="string"&&(n=t.__e)){var o=t.__np,r=t.props,l=n.U;if(l)for(var a in l){var c=l[a];c===void 0||o&&a in o||
(c.d(),l[a]=void 0)}if(o){l||(l={},n.U=l);for(var d in o){var m=l[d],g=o[d];m===void 0?(m=lm(n,d,g,r),l[d]=m):m.o(g,r)}}}
e(t)});function lm(e,t,n,o){var r=t in e&&e.ownerSVGElement===void 0,l=I(n);return{o:function(a,c){l.value=a,o=c},d:Le(function(){
this.N=Uu;var a=l.value.value;o[t]!==a&&(o[t]=a,r?e[t]=a:a!=null&&(a!==!1||t[4]==="-")?e.setAttribute(t,a):e.removeAttribute(
t))})}}Vo("unmount",function(e,t){if(typeof t.type=="string"){var n=t.__e;if(n){var o=n.U;if(o){n.U=void 0;for(var r in o){
var l=o[r];l&&l.d()}}}var a=t.__np;if(a){var c=t.props;for(var d in a)c[d]=a[d]}t.__np=void 0}else{var m=t.__c;if(m){m.__$f|=
8;var g=m.__$u;g&&(m.__$u=void 0,g.d())}}e(t)});Vo("__h",function(e,t,n,o){o<3&&(t.__$f|=2),e(t,n,o)});Lo.prototype.shouldComponentUpdate=
function(e,t){if(this.__R)return!0;var n=this.__$u,o=n&&n.s!==void 0;for(var r in t)return!0;if(this.__f||typeof this.u==
"boolean"&&this.u===!0){var l=2&this.__$f;if(!(o||l||4&this.__$f)||1&this.__$f)return!0}else if(!(o||4&this.__$f)||3&this.
__$f)return!0;for(var a in e)if(a!=="__source"&&e[a]!==this.props[a])return!0;for(var c in this.props)if(!(c in e))return!0;
return!1};function im(e,t){return vl(function(){return I(e,t)},[])}var sm=function(e){queueMicrotask(function(){queueMicrotask(e)})};function am(){un(function(){for(var e;e=zu.shift();)Vu.call(e)})}function Uu(){zu.push(this)===1&&(re.requestAnimationFrame||
sm)(am)}var um=95,as=new Set,us=!1,Wu=0;function Gu(e){if(e-Wu<um){requestAnimationFrame(Gu);return}us=!1,Wu=e;let t=[...as];as.
clear(),un(()=>t.forEach(n=>{n.value+=1}))}function kt(e){as.add(e),!us&&(us=!0,requestAnimationFrame(Gu))}var Bu={int8:1,uint8:1,int16:2,uint16:2,int32:4,uint32:4,int64:8,uint64:8,float32:4,float64:8,string:4},ju=e=>Bu[e],cm=/^# MAVLink (\S+) \((\d+)\)/,
fm=/^(\w+) (\w+)=(-?\d+)$/,pm=/^(\w+?)(?:\[(\d+)\])? (\w+)(?:\s*#(?: \[(.*?)\])?(?: invalid: (\S+))?)?$/;function dm(e){
let t=e.filter(n=>n!==0);return t.length>1&&Math.max(...t)>2&&t.every(n=>Number.isInteger(Math.log2(n)))}function mm(e,t,n){
let o=`${t.toUpperCase()}_`,r=e.slice(o.length);return e.startsWith(o)&&n.has(r)?r:e}function hm(e,t,n){if(t.length===0)
return null;let o=new Map(t.map(([r,l])=>[l,mm(r,e,n)]));for(let[r]of t)n.add(r);return o}function gm(e,t,n){let[,o="",r,
l="",a="",c=""]=e;if(!(o in Bu))throw new Error(`the schema has a type that MAVLink does not have: ${o}`);let d=hm(l,t,n);
return{name:l,type:o,length:r===void 0?null:Number(r),unit:a,invalid:c,entries:d,isFlags:d!==null&&dm([...d.keys()])}}function qu(e){
let t=e.split(`
`).map(a=>a.trim()).filter(a=>a!==""),n=t[0]?.match(cm),o=[],r=new Set,l=[];for(let a of t){let c=a.match(fm);c&&l.push(
[c[2]??"",Number(c[3])]);let d=c||a.startsWith("#")?null:a.match(pm);d&&(o.push(gm(d,l,r)),l=[])}return{name:n?.[1]??"",
id:n?Number(n[2]):null,fields:o,indexOf:new Map(o.map((a,c)=>[a.name,c]))}}var vm="mavlink/msg/",Yu=500,_m=1e4,bm=1e4,xm=8e3,ht=I(!1),Ho=I(null),Tr=I(null),Er=I(""),Nr=I(""),qt=I(0),at=new Map,cs=new Map,
Ar=new Map,zo=new Map,Ku=new Set,Qn=null,Mr=Yu,kl=0,Ml=0;function wm(e){if(!e.schemaName.startsWith(vm))return null;let t=cs.
get(e.schemaName);if(t)return t;let n=qu(e.schema);return cs.set(e.schemaName,n),n}function Zu(e){Qn?.readyState===WebSocket.
OPEN&&Qn.send(JSON.stringify(e))}function Ju(e){let t=e.flatMap(n=>at.get(n)?.id??[]);t.length>0&&Zu({op:"subscribe",subscriptions:t.
map(n=>({id:n,channelId:n}))})}function ym(e){let t=at.get(e);t&&Zu({op:"unsubscribe",subscriptionIds:[t.id]})}function Sm(e){
for(let t of e)at.set(t.topic,{id:t.id,topic:t.topic,encoding:t.encoding,schema:wm(t)}),Ar.set(t.id,t.topic);Ju(e.map(t=>t.
topic).filter(t=>zo.has(t))),kt(qt)}function km(e){for(let t of e){let n=Ar.get(t);n!==void 0&&at.get(n)?.id===t&&at.delete(
n),Ar.delete(t)}kt(qt)}function Mm(e){let t=JSON.parse(e);t.op==="advertise"?Sm(t.channels??[]):t.op==="unadvertise"?km(
t.channelIds??[]):t.op==="serverInfo"?Er.value=t.name??"":t.op==="status"&&t.id==="drops"?Nr.value=t.message??"":t.op===
"status"&&console.warn(t.message)}function Tm(e){let t=new DataView(e);if(t.byteLength<13||t.getUint8(0)!==1)return;let n=zo.
get(Ar.get(t.getUint32(1,!0))??""),o=Number(t.getBigUint64(5,!0)/1000n),r=new DataView(e,13);n?.forEach(l=>l(r,o))}function Am(){
Ml=performance.now(),Mr=Yu,un(()=>{ht.value=!0,Ho.value=Tr.value=null});for(let e of Ku)e()}function Xu(){clearTimeout(kl),
Qn=null,at.clear(),Ar.clear(),cs.clear(),un(()=>{(ht.value||Tr.value===null)&&(Tr.value=Date.now()),ht.value=!1,Ho.value=
Date.now()+Mr,Nr.value=""}),kl=window.setTimeout(Pr,Mr),Mr=Math.min(_m,Mr*1.6)}function Qu(){document.addEventListener("\
visibilitychange",()=>{Ml=performance.now()}),setInterval(()=>{if(!ht.value||document.hidden||performance.now()-Ml<bm)return;
let e=Qn;Xu(),e?.close()},1e3)}function Pr(){if(clearTimeout(kl),Qn)return;Ho.value=null;let e=new WebSocket(`${location.
protocol==="https:"?"wss":"ws"}://${location.host}/`,["foxglove.sdk.v1","foxglove.websocket.v1"]);e.binaryType="arraybuf\
fer",e.onopen=Am,e.onclose=()=>{Qn===e&&Xu()},e.onmessage=({data:t})=>{Ml=performance.now(),typeof t=="string"?Mm(t):Tm(
t)},Qn=e,kl=window.setTimeout(()=>{e.readyState===WebSocket.CONNECTING&&e.close()},xm)}function Uo(e,t){let n=zo.get(e)??
new Set;return n.add(t),zo.set(e,n),n.size===1&&Ju([e]),()=>{n.delete(t),!(n.size>0||zo.get(e)!==n)&&(zo.delete(e),ym(e))}}
function ec(e){Ku.add(e),ht.value&&e()}var Tl=I(!document.hidden);document.addEventListener("visibilitychange",()=>{Tl.value=!document.hidden});var Em=new TextDecoder,
eo=class{constructor(t,n){this.take=n;ec(()=>{this.loads.value+=1}),Le(()=>{if(!(this.wanted.value===0||!Tl.value||this.
loads.value===0))return this.isNew=!0,Uo(`/mavloom/${t}`,o=>this.apply(Em.decode(o)))})}take;version=I(0);wanted=I(0);loads=I(
0);isNew=!0;use(){return this.wanted.value+=1,()=>{this.wanted.value-=1}}apply(t){this.take(JSON.parse(t),this.isNew),this.
isNew=!1,kt(this.version)}},fs=0,tc=0;function Or(e){fs=e,tc=performance.now()}function to(){return fs===0?Date.now()/1e3:
fs/1e6+(ht.peek()?(performance.now()-tc)/1e3:0)}var gt=I(0);setInterval(()=>{document.hidden||(gt.value+=1)},1e3);var Al=I([]),El=I([]),Wo=I([]),ps=I(0),vt=new Map,Nl=new eo("vehicles",e=>{Or(e.time_us),Al.value=e.vehicles}),no=new eo(
"alarms",e=>{Or(e.time_us),Wo.value=e.alarms,ps.value=e.left_out}),Fn=e=>`${e.sys}/${e.comp}`;function ds(e){return Wo.value.
filter(t=>t.ended_us===null&&t.sys===e.sys&&(t.comp===null||t.comp===e.comp))}var ms=e=>e.autopilot!==null&&e.autopilot!==
"MAV_AUTOPILOT_INVALID"&&e.type!=="MAV_TYPE_GCS",nc=120,Fr=new Map,oc=e=>[e,...e.links].flatMap(t=>t.losses),Pl=e=>oc(e).
reduce((t,n)=>t+n.count,0),Nm=["fault_corrupted","fault_cut"],rc=e=>oc(e).some(t=>t.count>0&&Nm.includes(t.name));function Pm(e){
let t=Fr.get(e.name)??{rates:[],lost:[]};Fr.set(e.name,t),t.rates.push(Math.max(e.hz_in??0,e.hz_out??0)),t.lost.push({at:performance.
now()/1e3,total:Pl(e)}),t.rates.length>nc&&t.rates.shift(),t.lost.length>nc&&t.lost.shift()}function hs(e){let t=performance.
now()/1e3,n=Fr.get(e.name)?.lost.find(o=>o.at>=t-10);return n?{count:Math.max(0,Pl(e)-n.total),seconds:Math.round(t-n.at)}:
{count:0,seconds:0}}var vn=new eo("links",e=>{Or(e.time_us),El.value=e.hops,e.hops.forEach(Pm)}),lc=()=>El.value.flatMap(
e=>e.hint??[]),ic=0,Om=4e5,Fm=2e4,Cm=60;function Dm(e,t){let n=`${e.link??""} ${e.topic}`,o=vt.get(n)?.newAt??(t<ic+Om?0:
t/1e6);vt.set(n,{...e,key:n,seenAt:t/1e6-(e.age_s??0),newAt:o})}function Lm(){if(!(vt.size<=Fm))for(let e of vt.values())
Go(e)>Cm&&vt.delete(e.key)}var Ol=new eo("traffic",(e,t)=>{Or(e.time_us),t&&(vt.clear(),ic=e.time_us);for(let n of e.rows)
Dm(n,e.time_us);Lm()}),Go=e=>Math.max(0,to()-e.seenAt),Fl=(e,t=Go(e))=>e.silent_after_s!=null&&t>e.silent_after_s;function Cl(e,t=Go(
e)){return Fl(e,t)?0:t>1.5&&t*e.hz>3?1/t:e.hz}var $m=["overview","messages","plots"],oo=["link","source","name","id","hz","count","bytes","share","gaps","jitter","age"],
Rm=["source","name","hz","count","share","jitter","age"],gs=[10,30,60,300,900],$l=8,vs=8;function ac(){return{view:"over\
view",query:"",sort:{column:"source",isDown:!1},columns:[...Rm],opened:null,plots:[],span:60}}var Dl=e=>encodeURIComponent(
e).replace(/[~!']/g,t=>`%${t.charCodeAt(0).toString(16).toUpperCase()}`).replaceAll("%2F","/").replaceAll("%2C",",");function Ll(e){
try{return decodeURIComponent(e)}catch{return""}}function Im(e){let t=[Dl(e.topic),Dl(e.formula),String(e.axis),String(e.
scale),String(e.offset)],n=["","","0","1","0"];for(;t.length>2&&t.at(-1)===n[t.length-1];)t.pop();return t.join("~")}var sc=(e,t)=>e!==
void 0&&e!==""&&Number.isFinite(Number(e))?Number(e):t;function Vm(e){let[t="",n="",o,r,l]=e.split("~"),a=Ll(t),c=Ll(n);
return a===""||c===""?[]:[{topic:a,formula:c,axis:o==="1"?1:0,scale:sc(r,1),offset:sc(l,0)}]}function Rl(e){let t=ac(),n=[],
o=(r,l,a)=>{l!==a&&n.push(`${r}=${l}`)};o("q",Dl(e.query),""),o("sort",`${e.sort.isDown?"-":""}${e.sort.column}`,t.sort.
column),o("cols",e.columns.join(","),t.columns.join(",")),o("open",Dl(e.opened??""),""),o("span",String(e.span),String(t.
span));for(let r of e.plots)n.push(`plot=${r.map(Im).join("!")}`);return e.view+(n.length>0?`?${n.join("&")}`:"")}function zm(e,t){
t.length>0&&e.plots.push(t)}function Hm(e,t,n){if(t==="q"&&(e.query=Ll(n)),t==="open"&&(e.opened=Ll(n)||null),t==="span"&&
gs.includes(Number(n))&&(e.span=Number(n)),t==="cols"&&(e.columns=oo.filter(r=>r==="name"||n.split(",").includes(r))),t===
"plot"&&e.plots.length<$l&&zm(e,n.split("!").flatMap(Vm).slice(0,vs)),t!=="sort")return;let o=n.replace(/^-/,"");oo.includes(
o)&&(e.sort={column:o,isDown:n.startsWith("-")})}function _s(e){let t=ac(),[n="",o=""]=e.replace(/^#/,"").split("?",2);$m.
includes(n)&&(t.view=n);for(let r of o.split("&")){let l=r.indexOf("=");l>0&&Hm(t,r.slice(0,l),r.slice(l+1))}return t}var ro=_s(location.hash),He=I(ro.view),Cn=I(ro.query),_n=I(ro.sort),Dn=I(ro.columns),ye=I(ro.opened),he=I(ro.plots),Ln=I(
ro.span),Mt=I(!1),Cr=I(""),uc=0;function Bo(e){Cr.value=e,clearTimeout(uc),uc=window.setTimeout(()=>{Cr.value=""},4e3)}function bs(){
return{view:He.value,query:Cn.value,sort:_n.value,columns:Dn.value,opened:ye.value,plots:he.value,span:Ln.value}}function Um(e){
un(()=>{He.value=e.view,Cn.value=e.query,_n.value=e.sort,Dn.value=e.columns,ye.value=e.opened,he.value=e.plots,Ln.value=
e.span})}function cc(){let e=`${He.value} ${ye.value}`;Le(()=>{let n=`#${Rl(bs())}`,o=`${He.value} ${ye.value}`;n!==location.
hash&&history[o===e?"replaceState":"pushState"](null,"",n),e=o});let t=()=>{let n=_s(location.hash);e=`${n.view} ${n.opened}`,
Um(n)};addEventListener("popstate",t)}function jo(e,t){return{topic:e,formula:t,axis:0,scale:1,offset:0}}function Dr(e,t=he.
value.length>0?he.value.length-1:null){let n=t===null?void 0:he.value[t];if(n?.some(r=>r.topic===e.topic&&r.formula===e.
formula))return Bo(`${e.formula} is in plot ${(t??0)+1} already`);if(n&&n.length<vs)return he.value=he.value.map((r,l)=>l===
t?[...r,e]:r),Bo(`${e.formula} added to plot ${(t??0)+1}`);if(he.value.length===$l)return Bo(`there are ${$l} plots alre\
ady: remove one first`);he.value=[...he.value,[e]],Bo(`${e.formula} added to plot ${he.value.length}`)}var Wm=new Intl.NumberFormat("en-US"),Gm=new Intl.NumberFormat("en-US",{minimumFractionDigits:1,maximumFractionDigits:1}),
ut=e=>e==null?"\u2013":Wm.format(e);function $e(e,t){return e==null||!Number.isFinite(e)?"\u2013":e.toFixed(t).replace(/^-(?=[0.]*$)/,
"")}function Tt(e){return e==null?"\u2013":e>=1e3?Gm.format(e):e>0&&e<.05?"<0.1":e.toFixed(1)}function Lr(e){if(e==null)
return"\u2013";let t=["B","kB","MB","GB","TB"],n=0;for(;e>=1e3&&n<t.length-1;)e/=1e3,++n;return`${n===0?e:e.toFixed(e<100?
1:0)} ${t[n]}`}function Yt(e){return e==null||!Number.isFinite(e)?"\u2013":e<1?"<1 s":e<120?`${Math.floor(e)} s`:e<7200?
`${Math.floor(e/60)} min`:e<172800?`${Math.floor(e/3600)} h`:`${Math.floor(e/86400)} d`}var Bm=e=>String(e).padStart(2,"\
0");function Il(e){let t=new Date(e/1e3);return[t.getHours(),t.getMinutes(),t.getSeconds()].map(Bm).join(":")}function $r(e,t){
if(typeof e=="string")return e;if(!t||typeof e=="bigint")return e.toString();if(!Number.isFinite(e))return Number.isNaN(
e)?"NaN":e>0?"\u221E":"\u2212\u221E";let n=Math.abs(e);return e!==0&&(n>=1e7||n<1e-6)?e.toExponential(4):e.toFixed(n>=1e3?
2:n>=100?3:n>=10?4:5)}function qo(e){let t=Math.abs(e);return Number.isFinite(e)?e!==0&&(t>=1e7||t<1e-4)?e.toExponential(
2):e.toFixed(t>=1e3?1:t>=100?2:t>=1?3:4):"\u2013"}var jm={px4:"PX4",ardupilotmega:"ArduPilot",gcs:"Ground station",adsb:"\
ADS-B",vtol:"VTOL",generic:"Generic autopilot"};function Rr(e,t){if(e==null)return"\u2013";let n=e.replace(new RegExp(`^${t}`),
"").replaceAll("_"," ").toLowerCase();return jm[n]??n.charAt(0).toUpperCase()+n.slice(1)}var qm=Symbol.for("pv"),Ym=0;function i(e,t,n,o,r,l){t||(t={});var a,c,d=t;if("ref"in d&&typeof e!="function")for(c in d={},t)c=="ref"?a=t[c]:d[c]=t[c];
var m={type:e,props:d,key:n,ref:a,__k:null,__:null,__b:0,__e:null,__c:null,constructor:qm,__v:--Ym,__i:-1,__u:0};return(r||
l)&&(m.__source=r,m.__self=l),re.vnode&&re.vnode(m),m}var Km={error:"M8 1.5 15 14H1Z",warning:"M8 1 15 8 8 15 1 8Z",info:"M8 1.5a6.5 6.5 0 1 0 .01 0Z",live:"M8 3.5a4.5 4.5 0 \
1 0 .01 0Z",lost:"M3 3 13 13M13 3 3 13",connecting:"M8 2a6 6 0 1 1-6 6",down:"M3 3 13 13M13 3 3 13",up:"M8 3.5a4.5 4.5 0\
 1 0 .01 0Z",ended:"M3 8.5 6.5 12 13 4.5",auto:"M8 2a6 6 0 1 0 .01 0M8 2v12a6 6 0 0 0 0-12",light:"M8 5a3 3 0 1 0 .01 0M\
8 1v1.5M8 13.5V15M1 8h1.5M13.5 8H15M3 3l1 1M12 12l1 1M13 3l-1 1M4 12l-1 1",dark:"M13.5 9.5A6 6 0 1 1 6.5 2.5 5 5 0 0 0 1\
3.5 9.5Z",help:"M5.5 5.5a2.5 2.5 0 1 1 3.5 2.3c-.7.4-1 .8-1 1.7M8 12.5v.3",close:"M4 4 12 12M12 4 4 12",plot:"M2 2v12h12\
M4.5 10.5 7.5 6.5 10 9 13.5 4",pause:"M5.5 3v10M10.5 3v10",play:"M5 3 13 8 5 13Z",arrow:"M1 8h13M10 4l4 4-4 4"},Zm=["err\
or","warning","info","live","up","play"];function ue({name:e}){return i("svg",{class:`icon ${Zm.includes(e)?"filled":""}`,
viewBox:"0 0 16 16","aria-hidden":"true",children:i("path",{d:Km[e]})})}var Vl=["auto","light","dark"],fc="mavloom-colours";function Jm(){let e=localStorage.getItem(fc);return Vl.includes(e)?e:
"auto"}var $n=I(Jm()),xs=I(0);function ws(){document.documentElement.dataset.theme=$n.value,xs.value+=1}function zl(){$n.
value=Vl[(Vl.indexOf($n.value)+1)%Vl.length],localStorage.setItem(fc,$n.value),ws()}matchMedia("(prefers-color-scheme: l\
ight)").addEventListener("change",ws);ws();var Yo=8;function lo(e){let t=document.createElement("i");t.style.color=`var(\
--${e})`,document.body.append(t);let n=getComputedStyle(t).color;return t.remove(),n}var nt=class extends Error{constructor(n,o){super(n);this.at=o}at},pc={pi:Math.PI,e:Math.E},dc=180/Math.PI,et=e=>({least:1,
most:1,call:e}),mc=e=>({least:2,most:2,call:e}),ys=e=>({least:1,most:1/0,call:e}),Ts={abs:et(Math.abs),acos:et(Math.acos),
asin:et(Math.asin),atan:et(Math.atan),atan2:mc(Math.atan2),ceil:et(Math.ceil),cos:et(Math.cos),deg:et(e=>e*dc),exp:et(Math.
exp),floor:et(Math.floor),hypot:ys(Math.hypot),log:et(Math.log),log10:et(Math.log10),max:ys(Math.max),min:ys(Math.min),mod:mc(
(e,t)=>e-t*Math.floor(e/t)),rad:et(e=>e/dc),round:et(Math.round),sign:et(Math.sign),sin:et(Math.sin),sqrt:et(Math.sqrt),
tan:et(Math.tan)},Es=Object.keys(Ts),Ss=/\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?)|([A-Za-z_]\w*)|([-+*/%^()[\],]))/y,
ks=/\s*(\/\d+\/\d+\/[A-Za-z_]\w*(?:\/\w+)?)\./y,Ms=500,hc=50,Xm=e=>e===void 0||e.kind==="sign"&&e.text!==")"&&e.text!=="\
]";function Qm(e){let t=[],n=0;for(;e.slice(n).trim()!=="";){let o=n+(e.slice(n).length-e.slice(n).trimStart().length);ks.
lastIndex=Ss.lastIndex=n;let r=Xm(t.at(-1))?ks.exec(e):null,l=r??Ss.exec(e);if(!l)throw new nt(`'${[...e.slice(o)][0]}' \
does not belong in a formula`,o);let[,a,c,d]=l,m=r?"topic":a?"number":c?"name":"sign";t.push({kind:m,text:a??c??d??"",at:o}),
n=r?ks.lastIndex:Ss.lastIndex}return t.push({kind:"end",text:"",at:e.length}),t}var eh={"+":(e,t)=>e+t,"-":(e,t)=>e-t},th={
"*":(e,t)=>e*t,"/":(e,t)=>e/t,"%":(e,t)=>e%t},As=class{constructor(t){this.all=t}all;uses=[];next=0;depth=0;whole(){let t=this.
sum();return this.token.kind!=="end"&&this.fail(`expected an operator before '${this.token.text}'`),t}get token(){return this.
all[this.next]}fail(t,n=this.token.at){throw new nt(t,n)}accept(t){return this.token.kind!=="sign"||this.token.text!==t?
!1:(++this.next,!0)}expect(t,n){this.accept(t)||this.fail(`expected '${t}' ${n}`)}chain(t,n){let o=n();for(let r=this.operator(
t);r;r=this.operator(t)){let l=o,a=n(),c=r;o=d=>c(l(d),a(d))}return o}operator(t){let{kind:n,text:o}=this.token;return n!==
"sign"||!Object.hasOwn(t,o)?null:(++this.next,t[o])}sum(){++this.depth>hc&&this.fail("too many parentheses");let t=this.
chain(eh,()=>this.chain(th,()=>this.signed()));return--this.depth,t}signed(){let t=!1;for(;;)if(this.accept("-"))t=!t;else if(!this.
accept("+"))break;let n=this.power();return t?o=>-n(o):n}power(){let t=this.primary();if(!this.accept("^"))return t;++this.
depth>hc&&this.fail("too many powers");let n=this.signed();return--this.depth,o=>t(o)**n(o)}primary(){let{kind:t,text:n,
at:o}=this.token;if(this.accept("(")){let r=this.sum();return this.expect(")","for the '(' before"),r}if(t==="end"&&this.
fail("the formula ends too early: a number or a field is missing"),t==="sign"&&this.fail(`expected a number or a field b\
efore '${n}'`),++this.next,t==="number"){let r=Number(n);return()=>r}return t==="topic"?this.fieldOf(n):this.accept("(")?
this.call(n,o):this.named(n,o)}fieldOf(t){let{kind:n,text:o,at:r}=this.token;return n!=="name"&&this.fail(`expected a fi\
eld of ${t}`),++this.next,this.field(t,o,r)}named(t,n){let o=Object.hasOwn(pc,t)?pc[t]:void 0,r=this.token.kind==="sign"&&
this.token.text==="[";return o!==void 0&&!r?()=>o:this.field(null,t,n)}field(t,n,o){let r=this.accept("[")?this.element():
null;return this.uses.push({topic:t,name:n,element:r,at:o}),l=>l(n,r,t)}element(){let{kind:t,text:n}=this.token;return(t!==
"number"||!/^\d+$/.test(n))&&this.fail("expected the number of an array element, as in [0]"),++this.next,this.expect("]",
"after the number of the element"),Number(n)}call(t,n){let o=Object.hasOwn(Ts,t)?Ts[t]:void 0;o||this.fail(`there is no \
function '${t}'; there are ${Es.join(", ")}`,n);let r=this.arguments();if(r.length<o.least||r.length>o.most){let l=o.most===
1/0?"at least one value":o.least===1?"one value":`${o.least} values`;this.fail(`${t} takes ${l}, not ${r.length}`,n)}return l=>o.
call(...r.map(a=>a(l)))}arguments(){if(this.accept(")"))return[];let t=[this.sum()];for(;this.accept(",");)t.push(this.sum());
return this.expect(")","after the values of the function"),t}};function Ir(e){if(e.length>Ms)throw new nt(`a formula has\
 at most ${Ms} characters`,Ms);let t=new As(Qm(e));return{formula:t.whole(),uses:t.uses}}var vc="mavloom-keys",Ko=I(localStorage.getItem(vc)!=="off");function _c(){Ko.value=!Ko.value,localStorage.setItem(vc,Ko.
value?"on":"off")}var Hl=new Map;function Ul(e){for(let[t,n]of Object.entries(e))Hl.set(t,n);return()=>{for(let[t,n]of Object.
entries(e))Hl.get(t)===n&&Hl.delete(t)}}var gc="";function Rn(e,t=30){gc=e,requestAnimationFrame(()=>{if(gc!==e)return;let n=document.
querySelector(e);n?n.focus({preventScroll:!0}):t>0&&Rn(e,t-1)})}function Ns(){let e=ye.value,t=document.activeElement?.closest(
"aside.message")!=null;if(ye.value=null,!t||e===null)return;(document.querySelector(`[data-row$="${CSS.escape(` ${e}`)}"\
]`)??document.querySelector("main .scroller"))?.focus()}var nh={1:()=>{He.value="overview"},2:()=>{He.value="messages"},
3:()=>{He.value="plots"},"?":()=>{Mt.value=!Mt.value},t:zl,"/":()=>{He.value="messages",Rn("#search")}};function bc(e){return e instanceof
HTMLElement?e instanceof HTMLInputElement&&e.type!=="checkbox"||e instanceof HTMLTextAreaElement||e instanceof HTMLSelectElement:
!1}function oh(){let e=document.querySelector("details[open]");return e&&(e.open=!1),e?.querySelector("summary")?.focus(),
e!==null}function rh(e){if(Mt.value)Mt.value=!1;else{if(oh())return;bc(e)?e.blur():Ns()}}function xc(e){if(e.ctrlKey||e.
metaKey||e.altKey||e.defaultPrevented)return;if(e.key==="Escape")return e.preventDefault(),rh(e.target);if(bc(e.target)||
!Ko.value&&e.key.length===1||e.key===" "&&e.target instanceof HTMLButtonElement)return;let t=Hl.get(e.key)??nh[e.key];!t||
Mt.value&&e.key!=="?"||(e.preventDefault(),t(e))}var lh=[["Everywhere",[["1 2 3","Overview, Messages, Plots"],["/","search messages"],["t","light, dark, as the system"],
["Esc","close, leave a field"],["?","this list"]]],["Messages",[["j k, \u2193 \u2191","next, previous row"],["Enter","op\
en the row"],["f","freeze the table"],["c","compare with the frozen state"],["Tab","to the open message: its close butto\
n, then its fields; Enter plots one"]]],["Plots",[["Space","stop, follow again"],["+ \u2212","zoom"],["\u2190 \u2192","e\
arlier, later"],["0","follow the latest"],["a","add a formula"]]]];function ih({title:e,keys:t}){return i("section",{children:[
i("h3",{children:e}),i("dl",{class:"keys",children:t.map(([n,o])=>[i("dt",{children:i("kbd",{children:n})},n),i("dd",{children:o},
o)])})]})}var sh=()=>i("p",{children:["Formulas have fields, array elements such as ",i("code",{children:"voltages[0]"}),
", ",i("code",{children:"+ - * / % ^ ( )"}),","," ",i("code",{children:"pi"}),", ",i("code",{children:"e"})," and"," ",Es.
map((e,t)=>[t>0?", ":"",i("code",{children:e},e)]),". A field of another topic has its name before it, as in ",i("code",
{children:"alt - /2/1/VFR_HUD.alt"}),": the latest value counts."]});function wc(){Mt.value=!1}function yc(){let e=$t(null);
return Qe(()=>{Mt.value&&!e.current?.open&&e.current?.showModal(),!Mt.value&&e.current?.open&&e.current?.close()},[Mt.value]),
i("dialog",{ref:e,"aria-labelledby":"help-title",onClose:wc,children:[i("header",{children:[i("h2",{id:"help-title",children:"\
Keys"}),i("button",{class:"quiet",onClick:wc,"aria-label":"Close",children:i(ue,{name:"close"})})]}),i("div",{class:"gro\
ups",children:lh.map(([t,n])=>i(ih,{title:t,keys:n},t))}),i("label",{class:"check",children:[i("input",{type:"checkbox",
checked:Ko.value,onChange:_c})," Keys of one letter work"]}),i(sh,{}),i("p",{class:"dim",children:[Er.value," \xB7 ",i("\
a",{href:"licences.txt",children:"Licences of what this page contains"})]})]})}var Wl=4,ah=new TextDecoder;function Sc(e){return e<=Number.MAX_SAFE_INTEGER&&e>=Number.MIN_SAFE_INTEGER?Number(e):e}var uh={
int8:(e,t)=>e.getInt8(t),uint8:(e,t)=>e.getUint8(t),int16:(e,t)=>e.getInt16(t,!0),uint16:(e,t)=>e.getUint16(t,!0),int32:(e,t)=>e.
getInt32(t,!0),uint32:(e,t)=>e.getUint32(t,!0),int64:(e,t)=>Sc(e.getBigInt64(t,!0)),uint64:(e,t)=>Sc(e.getBigUint64(t,!0)),
float32:(e,t)=>e.getFloat32(t,!0),float64:(e,t)=>e.getFloat64(t,!0)},Ps=class{constructor(t){this.data=t}data;at=Wl;field(t){
if(t.length===null)return this.scalar(t.type);let n=new Array(t.length);for(let o=0;o<t.length;++o)n[o]=this.scalar(t.type);
return n}scalar(t){let n=ju(t);if(this.at=Wl+Math.ceil((this.at-Wl)/n)*n,t==="string")return this.text();let o=uh[t](this.
data,this.at);return this.at+=n,o}text(){let t=this.data.getUint32(this.at,!0),n=new Uint8Array(this.data.buffer,this.data.
byteOffset+this.at+4,Math.max(0,t-1));return this.at+=4+t,ah.decode(n)}};function Gl(e,t){if(t.byteLength<Wl||t.getUint8(
1)!==1)throw new RangeError("not a little-endian CDR message");let n=new Ps(t);return e.fields.map(o=>n.field(o))}function kc(e,t,n){
let o=e[t],r=Array.isArray(o)?o[n??0]:o;return typeof r=="string"||r===void 0?NaN:Number(r)}var Bl=I(0),Os=null;function jl(){Bl.value,qt.value;let e=ye.value;if(e===null)return null;let t=Os?.topic===e?Os:null,n=t?.
schema??at.get(e)?.schema;if(!n)return null;let o={topic:e,schema:n,message:null,timeUs:t?.timeUs??0,error:""};if(!t)return o;
try{return{...o,message:Gl(n,t.data)}}catch(r){return{...o,error:String(r)}}}function Mc(){Le(()=>{let e=ye.value;if(!(e===
null||!Tl.value))return Uo(e,(t,n)=>{let o=at.get(e)?.schema;o&&(Os={topic:e,schema:o,data:t,timeUs:n},kt(Bl))})})}var Ee=I(null),Rt=I(!1);function ql(){Ee.value={at:to(),opened:jl(),rows:new Map(vt)},Rt.value=!1}function Fs(){Ee.value=
null,Rt.value=!1}function Cs(){Ee.value===null&&ql(),Rt.value=!Rt.value}var Ac=()=>Ee.value&&!Rt.value?Ee.value.rows:vt;
function Ds(e){let t=Ee.value;return t&&!Rt.value?Fl(e,t.at-e.seenAt)?"silent":"":(t?!t.rows.has(e.key):e.newAt>0&&to()-
e.newAt<10)?"new":Fl(e)?"silent":""}var Ls=e=>Ee.value&&!Rt.value?Math.max(0,Ee.value.at-e.seenAt):Go(e),zr=e=>Cl(e,Ls(e));
function ch(e){let t=e.toLowerCase().split(/\s+/).filter(r=>r!==""),n=t.filter(r=>/^\d+\/\d*$/.test(r)),o=t.filter(r=>!n.
includes(r));return r=>{let l=`${r.sys}/${r.comp}`;return n.every(c=>c.endsWith("/")?l.startsWith(c):l===c)&&o.every(c=>fh(
r).includes(c))}}var Tc=new WeakMap;function fh(e){let t=Tc.get(e);if(t!==void 0)return t;let n=`${e.topic} ${e.link??""}\
 ${e.id}`.toLowerCase();return Tc.set(e,n),n}var Zo=e=>e===0?0:Number(e.toPrecision(2)),ph={source:e=>e.sys*256+e.comp,id:e=>e.
id,hz:e=>Zo(zr(e)),count:e=>Zo(e.count),bytes:e=>Zo(e.bytes),share:e=>Zo(e.share),gaps:e=>Zo(e.gap_max_ms??-1),jitter:e=>Zo(
e.jitter_ms??-1),age:e=>Math.floor(Go(e))},dh=(e,t)=>e.sys-t.sys||e.comp-t.comp||Vr(e.name,t.name)||mh(e.instance,t.instance)||
Vr(e.key,t.key),Vr=(e,t)=>e<t?-1:e>t?1:0,mh=(e,t)=>Number(e)-Number(t)||Vr(String(e??""),String(t??""));function hh(e){let t=ph[e];
return t?(n,o)=>t(n)-t(o):e==="link"?(n,o)=>Vr(n.link??"",o.link??""):(n,o)=>Vr(n.name,o.name)}function Ec(e,t,n){let o=hh(
n.column),r=n.isDown?-1:1;return[...e].filter(ch(t)).sort((l,a)=>r*o(l,a)||dh(l,a))}var Nc=6;function gh(e){let t=$t(null),[n,o]=Fu({top:0,height:800,row:26});Ro(()=>{let l=t.current;if(!l)return;let a=()=>{
let d=parseFloat(getComputedStyle(l).getPropertyValue("--row"))||26;o({top:l.scrollTop,height:l.clientHeight,row:d})},c=new ResizeObserver(
a);return c.observe(l),l.addEventListener("scroll",a,{passive:!0}),()=>{c.disconnect(),l.removeEventListener("scroll",a)}},
[]);let r=Math.max(0,Math.min(e,Math.floor(n.top/n.row)-Nc));return{scroller:t,row:n.row,first:r,end:Math.min(e,Math.ceil(
(n.top+n.height)/n.row)+Nc)}}function vh({columns:e,sort:t,onSort:n}){let o=t?.isDown?"descending":"ascending";return i(
"thead",{children:i("tr",{"aria-rowindex":1,children:e.map(r=>i("th",{scope:"col",title:r.help,class:`c-${r.key} ${r.isNumber?
"number":""}`,"aria-sort":t?.column===r.key?o:void 0,children:n&&r.label!==""?i("button",{onClick:()=>n(r.key),children:r.
label}):r.label||i("span",{class:"hidden",children:r.help})},r.key))})})}var Pc=({rows:e,row:t})=>e<=0?null:i("tr",{class:"\
spacer","aria-hidden":"true",children:i("td",{style:{height:`${e*t}px`}})});function _h({current:e,rows:t,keyOf:n},o){Qe(
()=>{let r=o.scroller.current,l=t.findIndex(d=>n(d)===e);if(!r||l<0)return;let a=l*o.row,c=r.clientHeight-2*o.row;a<r.scrollTop?
r.scrollTop=a:a>r.scrollTop+c&&(r.scrollTop=a-c)},[e])}function bh({columns:e,row:t}){return i(te,{children:e.map(n=>i("\
td",{class:`c-${n.key} ${n.isNumber?"number":""}`,children:n.cell(t)},n.key))})}function Yl(e){let{caption:t,columns:n,rows:o,
keyOf:r,classOf:l,current:a}=e,c=gh(o.length),{scroller:d,row:m,first:g,end:_}=c,x=v=>`${l?.(v)??""} ${r(v)===a?"current":
""}`;return _h(e,c),i("div",{class:"scroller",ref:d,tabIndex:-1,children:i("table",{"aria-rowcount":o.length+1,children:[
i("caption",{class:"hidden",children:t}),i("colgroup",{children:n.map(v=>i("col",{class:`c-${v.key}`},v.key))}),i(vh,{...e}),
i("tbody",{children:[i(Pc,{rows:g,row:m}),o.slice(g,_).map((v,k)=>i("tr",{"aria-rowindex":g+k+2,class:x(v),children:bh({
columns:n,row:v})},r(v))),i(Pc,{rows:o.length-_,row:m})]})]})})}var xh={degE7:[1e-7,"\xB0",7],cdeg:[.01,"\xB0",2],rad:[180/Math.PI,"\xB0",2],"rad/s":[180/Math.PI,"\xB0/s",2],mm:[.001,"\
m",3],cm:[.01,"m",2],"cm/s":[.01,"m/s",2],"mm/s":[.001,"m/s",3],mV:[.001,"V",3],cV:[.01,"V",2],cA:[.01,"A",2],mA:[.001,"\
A",3],cdegC:[.01,"\xB0C",2],"c%":[.01,"%",2],"d%":[.1,"%",1]},Oc=e=>String(Math.floor(e)).padStart(2,"0"),wh=e=>`${Math.
floor(e/3600)}:${Oc(e/60%60)}:${Oc(e%60)}`;function Fc(e){return e>1e9?new Date(e*1e3).toISOString().slice(0,19).replace(
"T"," "):wh(e)}function Cc(e,t){let n=Number(e);if(!Number.isFinite(n))return"";if(t==="us"&&n>=1e6)return Fc(n/1e6);if(t===
"ms"&&n>=1e4)return Fc(n/1e3);let o=xh[t];if(!o)return"";let[r,l,a]=o;return`${Math.abs(n*r)>=1e6?qo(n*r):$e(n*r,a)}${l.
startsWith("\xB0")&&l!=="\xB0C"&&l!=="\xB0/s"?"":" "}${l}`}function yh(e,t){let[,n,o,r]=e.match(/^(U?)INT(8|16|32|64)_(MAX|MIN)$/)??[];if(o===void 0)return Sh(e,t)??(e.toLowerCase()===
"nan"?NaN:Number(e));let l=Number(o)-(n?0:1);return r==="MAX"?2**l-1:n?0:-(2**l)}var Sh=(e,t)=>[...t.entries??[]].find(([
,n])=>n===e)?.[0];function $s(e,t,n){if(t===""||e===void 0)return!1;let o=yh(t,n);return Number(e)===o||Number.isNaN(o)&&
Number.isNaN(Number(e))}function Kl(e,t,n){let o=e.invalid;if(o===""||e.type==="string")return!1;let r=Array.isArray(t)?
t:[t],l=r[n??0];if(!o.startsWith("("))return $s(l,o,e);let a=o.slice(1,-1);return a.endsWith(":")?$s(r[0],a.slice(0,-1),
e):$s(l,a.includes(",")?a.split(",")[n??0]??"":a,e)}var Vs="application/x-mavloom-series",Rs=16,Zl=e=>e.type.startsWith("float"),Is=I(new Set);function kh(e){let t=Ee.value?.
opened;return t?.topic===e.topic&&t.schema===e.schema?t.message:null}function Mh(e,t){return[...e.entries??[]].filter(([
o])=>o!==0&&Math.floor(t/o)%2===1).map(([,o])=>Lc(o,e))}function Lc(e,t){let n=[...t.entries?.values()??[]];if(n.length<
2)return e;let o=0;for(;n.every(r=>r[o]===n[0]?.[o]&&o<r.length);)++o;return e.slice(n[0]?.lastIndexOf("_",o-1)===-1?0:(n[0]?.
lastIndexOf("_",o-1)??-1)+1)}var $c=({field:e,whole:t,element:n})=>Kl(e,t,n);function Rc(e){let{field:t,raw:n}=e;if(typeof n==
"string")return"";let o=t.entries?.get(Number(n));return o!==void 0?Lc(o,t):$c(e)?"unknown":t.isFlags?Mh(t,Number(n)).join(
", "):Cc(n,t.unit)}var Ic=({name:e})=>i(te,{children:e.split(/(?<=_)/).flatMap((t,n)=>n===0?[t]:[i("wbr",{},n),t])});function Th({
field:e,raw:t,formula:n}){let o=()=>Dr(jo(ye.value??"",n));return i("button",{class:"value mono",title:`Plot ${n}`,"aria\
-label":`Plot ${n}, ${$r(t,Zl(e))}`,onClick:o,children:$r(t,Zl(e))})}var Vc=36,Dc=()=>Ee.value?5:4;function Ah({field:e,
raw:t,before:n}){if(!Ee.value)return null;let o=n!==void 0&&!Object.is(n,t);return i("td",{class:`number mono ${o?"chang\
ed":"dim"}`,children:n===void 0?"":$r(n,Zl(e))})}function Eh(e){let{field:t,raw:n,formula:o}=e,r=Rc(e);return i(te,{children:[
i("td",{class:"number",children:i(Th,{field:t,raw:n,formula:o})}),i(Ah,{...e}),i("td",{class:"dim f-unit",children:$c(e)?
"":t.unit}),i("td",{class:"meaning",children:r.length>Vc?"":r})]})}function zc(e){let{field:t,raw:n,element:o}=e,r=o===null?
t.name:`${t.name}[${o}]`,l=typeof n=="string",a=l?n:Rc(e);return i(te,{children:[i("tr",{draggable:!l,onDragStart:d=>{d.
dataTransfer?.setData(Vs,JSON.stringify(jo(ye.value??"",r))),d.dataTransfer?.setData("text/plain",r)},class:o===null?"":
"element",children:[i("th",{scope:"row",children:o===null?i(Ic,{name:t.name}):`[${o}]`}),l?i("td",{class:"text",colSpan:Dc()-
1,children:n}):i(Eh,{...e,formula:r})]}),!l&&a.length>Vc&&i("tr",{class:"more",children:i("td",{colSpan:Dc(),children:a})})]})}
function Nh(e){let t=new Set(Is.value);t.delete(e)||t.add(e),Is.value=t}function Ph({field:e,all:t,isOpen:n,name:o}){let r=t.
slice(0,Rs).map(a=>$r(a,Zl(e))),l=`${t.length} elements`;return i("tr",{class:"array",children:[i("th",{scope:"row",children:i(
Ic,{name:e.name})}),i("td",{colSpan:Ee.value?2:1,class:"dim",children:t.length<=Rs?l:i("button",{class:"link","aria-expa\
nded":n,onClick:()=>Nh(o),children:l})}),i("td",{class:"dim f-unit",children:e.unit}),i("td",{class:"meaning mono cut",children:n?
"":`${r.join(" ")} \u2026`})]})}function Oh({field:e,all:t,before:n}){let o=`${ye.value} ${e.name}`,r=t.length<=Rs||Is.value.
has(o),l=Array.isArray(n)?n:[];return i(te,{children:[i(Ph,{field:e,all:t,isOpen:r,name:o}),r&&t.map((a,c)=>i(zc,{field:e,
raw:a,whole:t,element:c,before:l[c]},c))]})}function Fh({field:e,raw:t,before:n}){return Array.isArray(t)?i(Oh,{field:e,
all:t,before:n}):i(zc,{field:e,raw:t,whole:t,before:n,element:null})}var Ch=()=>i("thead",{class:Ee.value?"":"hidden",children:i(
"tr",{children:[i("th",{scope:"col",children:"Field"}),i("th",{scope:"col",class:"number",children:"Value"}),Ee.value&&i(
"th",{scope:"col",class:"number",children:"Then"}),i("th",{scope:"col",class:"f-unit",children:"Unit"}),i("th",{scope:"c\
ol",children:"Meaning"})]})});function Dh({now:e}){let t=kh(e),{schema:n,message:o}=e;return o?i("table",{class:`fields ${Ee.
value?"compared":""}`,children:[i("caption",{class:"hidden",children:["Fields of ",n.name]}),i("colgroup",{children:[i("\
col",{class:"f-name"}),i("col",{class:"f-value"}),Ee.value&&i("col",{class:"f-value"}),i("col",{class:"f-unit"}),i("col",
{})]}),i(Ch,{}),i("tbody",{children:n.fields.map((r,l)=>i(Fh,{field:r,raw:o[l],before:t?.[l]},r.name))})]}):i("p",{class:"\
empty",children:e.error||"No message has come yet."})}var Lh=()=>i("p",{class:"empty",children:qt.value>0&&ht.value?"Not\
hing with this name was heard.":"Waiting for the server."}),$h=({topic:e})=>i("header",{children:[i("h3",{children:i("sp\
an",{class:"mono cut",title:e,children:e})}),i("button",{class:"quiet end",onClick:Ns,"aria-label":"Close the message",title:"\
Close (Esc)",children:i(ue,{name:"close"})})]});function Jl({hz:e}){Bl.value,gt.value;let t=jl(),n=ye.value??"";return i(
"aside",{class:"message","aria-label":`Message ${n}`,children:[i($h,{topic:n}),i("p",{class:"dim number about",children:[
t&&`id ${t.schema.id}`,e!==null&&i("span",{children:[Tt(e)," /s"]}),t&&t.timeUs>0&&i("span",{children:["at ",Il(t.timeUs)]})]}),
i("div",{class:"scroller",tabIndex:-1,children:t?i(Dh,{now:t}):i(Lh,{})}),i("p",{class:"hint dim",children:He.value==="p\
lots"?"Click a number, or drag it into a plot.":"Click a number to plot it."})]})}function Xl({text:e}){let t=lc();return vn.version.value===0?i("p",{class:"empty",children:"The server has not reported \
yet."}):t.length===0?i("p",{class:"empty",children:e}):i("ul",{class:"empty hints",children:t.map(n=>i("li",{children:[n,
"."]},n))})}var Xo=I(null),Kt=mt(()=>(Ol.version.value,Ee.value,Rt.value,_n.value.column==="age"&&gt.value,Ec(Ac().values(),Cn.value,
_n.value))),Rh=mt(()=>{let e=new Map;for(let{topic:t}of Kt.value)e.set(t,(e.get(t)??0)+1);return e});function Ih(e){Xo.value=
e.key,ye.value=ye.value===e.topic?null:e.topic}var Vh=e=>e.link?.split("#").at(-1)??"";function zh({row:e}){let t=e.key===
(Xo.value??Kt.value[0]?.key);return i("button",{class:"name mono","data-row":e.key,tabIndex:t?0:-1,"aria-expanded":ye.value===
e.topic,onClick:()=>Ih(e),onFocus:()=>{Xo.value=e.key},children:[e.name,e.instance!==null&&i("span",{class:"instance",children:[
"/",e.instance]}),(Rh.value.get(e.topic)??0)>1&&i("span",{class:"by dim",children:Vh(e)})]})}function Hh(e){let t=Ds(e);
return t===""?null:i("span",{class:`mark ${t}`,children:t})}var Uh=({row:e})=>{let t=Ee.value?.rows.get(e.key);if(!t)return i(
te,{children:"\u2013"});let n=Math.abs(t.hz-Cl(e))>.1*Math.max(t.hz,e.hz,1);return i("span",{class:n?"changed":"dim",children:Tt(
t.hz)})},Wh=({row:e})=>{let t=e.count-(Ee.value?.rows.get(e.key)?.count??0);return i("span",{class:t===0?"dim":"",children:t>
0?`+${ut(t)}`:ut(t)})},Gh=e=>e.gap_min_ms==null?"\u2013":`${$e(e.gap_min_ms,0)} \u2013 ${$e(e.gap_max_ms,0)}`,Uc={mark:{
key:"mark",label:"",help:"new or silent",cell:Hh},link:{key:"link",label:"Link",cell:e=>i("span",{class:"cut",title:e.link??
"",children:e.link??"\u2013"})},source:{key:"source",label:"From",help:"system/component",cell:e=>i("span",{class:"mono",
children:[e.sys,"/",e.comp]})},name:{key:"name",label:"Message",cell:e=>i(zh,{row:e})},id:{key:"id",label:"Id",isNumber:!0,
cell:e=>e.id},hz:{key:"hz",label:"Rate /s",isNumber:!0,cell:e=>Tt(zr(e))},before:{key:"before",label:"Then /s",help:"the\
 rate in the frozen state",isNumber:!0,cell:e=>i(Uh,{row:e})},count:{key:"count",label:"Count",isNumber:!0,cell:e=>ut(e.
count)},more:{key:"more",label:"Since",help:"messages since the frozen state",isNumber:!0,cell:e=>i(Wh,{row:e})},bytes:{
key:"bytes",label:"Bytes",isNumber:!0,cell:e=>Lr(e.bytes)},share:{key:"share",label:"Share %",help:"of the link's bytes",
isNumber:!0,cell:e=>$e(e.share*100,1)},gaps:{key:"gaps",label:"Gaps ms",help:"shortest and longest time between two mess\
ages",isNumber:!0,cell:Gh},jitter:{key:"jitter",label:"Jitter ms",isNumber:!0,cell:e=>$e(e.jitter_ms,1)},age:{key:"age",
label:"Age",help:"since the latest message",isNumber:!0,cell:e=>Yt(Ls(e))}},Bh={hz:["hz","before"],count:["count","more"],
bytes:[],share:[],gaps:[],jitter:[]};function jh(){let e=oo.filter(o=>Dn.value.includes(o)),t=e.toSpliced(e.indexOf("nam\
e")+1,0,"mark");return(Rt.value?t.flatMap(o=>Bh[o]??[o]):t).flatMap(o=>Uc[o]??[])}function qh(e){if(!oo.includes(e))return;
let t=["source","name","link","id"].includes(e);_n.value=_n.value.column===e?{column:e,isDown:!_n.value.isDown}:{column:e,
isDown:!t}}function Yh(){let e=n=>{let o=Dn.value.includes(n);Dn.value=oo.filter(r=>r===n?!o:Dn.value.includes(r))},t=$t(
null);return Qe(()=>{let n=o=>{t.current&&!t.current.contains(o.target)&&(t.current.open=!1)};return document.addEventListener(
"pointerdown",n),()=>document.removeEventListener("pointerdown",n)},[]),i("details",{class:"chooser",ref:t,children:[i("\
summary",{children:"Columns"}),i("div",{class:"menu",children:oo.filter(n=>n!=="name").map(n=>i("label",{class:"check",children:[
i("input",{type:"checkbox",checked:Dn.value.includes(n),onChange:()=>e(n)})," ",Uc[n]?.label]},n))})]})}function Kh(){let e=Ee.
value;return i("span",{class:"group",children:[i("button",{"aria-pressed":e!==null,onClick:()=>e?Fs():ql(),title:"Freeze\
 the table (f)",children:[i(ue,{name:e?"play":"pause"}),e?"Thaw":"Freeze"]}),e&&i("button",{"aria-pressed":Rt.value,onClick:Cs,
title:"Live values beside the frozen ones (c)",children:"Compare"})]})}function Zh(){Ol.version.value;let e=Kt.value.reduce(
(n,o)=>n+zr(o),0),t=Ee.value===null?"":Rt.value?" \xB7 live, compared":" \xB7 frozen";return i("span",{class:"summary di\
m number",role:"status","aria-live":"off",children:[ut(Kt.value.length),Kt.value.length<vt.size&&` of ${ut(vt.size)}`," \
rows \xB7"," ",Math.round(e).toLocaleString("en-US")," /s",t]})}function Jh(){return i("div",{class:"toolbar",children:[
i("input",{id:"search",type:"search",placeholder:"Search: 1/1 battery","aria-label":"Search messages",value:Cn.value,autocomplete:"\
off",spellcheck:!1,onInput:e=>{Cn.value=e.currentTarget.value},onKeyDown:e=>{(e.key==="Enter"||e.key==="ArrowDown")&&Ql(
0)}}),i(Kh,{}),i(Yh,{}),i(Zh,{})]})}function Ql(e){let t=Kt.value[Math.max(0,Math.min(Kt.value.length-1,e))];t&&(Xo.value=
t.key,Rn(`[data-row="${CSS.escape(t.key)}"]`))}var Hc=()=>Kt.value.findIndex(e=>e.key===Xo.value),Jo=e=>()=>Ql(Hc()<0?0:
Hc()+e),Xh={j:Jo(1),ArrowDown:Jo(1),k:Jo(-1),ArrowUp:Jo(-1),PageDown:Jo(20),PageUp:Jo(-20),Home:()=>Ql(0),End:()=>Ql(1/0),
f:()=>Ee.value?Fs():ql(),c:Cs};function Qh(){let e=Kt.value.filter(t=>t.topic===ye.value);return e.length===0?null:e.reduce(
(t,n)=>t+zr(n),0)}function Wc(){return Qe(()=>Ol.use(),[]),Qe(()=>vn.use(),[]),Ro(()=>Ul(Xh),[]),gt.value,i(te,{children:[
i("h2",{class:"hidden",children:"Messages"}),i("div",{class:"list",children:[i(Jh,{}),i(Yl,{caption:"Messages, a row for\
 each sender, message and instance",columns:jh(),rows:Kt.value,keyOf:e=>e.key,current:Xo.value,sort:_n.value,onSort:qh,classOf:e=>`${Ds(
e)} ${e.topic===ye.value?"open":""}`}),vt.size===0&&i(Xl,{text:"No message has come yet."}),vt.size>0&&Kt.value.length===
0&&i("p",{class:"empty",children:"No message matches the search."})]}),ye.value!==null&&i(Jl,{hz:Qh()})]})}var zs=100;function Gc(e){return[e.sys===null?"":`${e.sys}${e.comp===null?"":`/${e.comp}`}`,e.link??""].filter(n=>n!=="").
join(" ")}function eg({alarm:e}){let t=e.ended_us!==null,n=(t?(e.ended_us??0)/1e6:to())-e.since_us/1e6;return i("li",{class:t?
"over":e.severity,children:[i("span",{class:"severity",children:[i(ue,{name:t?"ended":e.severity}),t?"over":e.severity]}),
i("time",{class:"number dim",dateTime:new Date(e.since_us/1e3).toISOString(),children:Il(e.since_us)}),i("span",{class:"\
mono about",children:Gc(e)}),i("span",{class:"text",children:e.text}),i("span",{class:"lasted number dim",children:t?`la\
sted ${Yt(n)}`:`for ${Yt(n)}`})]})}function tg({alarm:e}){return i("p",{class:"hidden",role:"status","aria-live":"polite",
children:e?`${e.severity}: ${Gc(e)} ${e.text}`:""})}var ng=({number:e})=>e===0?null:i("li",{class:"note dim",children:[ut(
e)," older ",e===1?"one has":"ones have"," left the list, which was full"]});function Bc(){no.version.value,gt.value;let e=[
...Wo.value].sort((n,o)=>+(n.ended_us!==null)-+(o.ended_us!==null)||o.since_us-n.since_us),t=e.filter(n=>n.ended_us===null);
return i("section",{"aria-labelledby":"alarms",children:[i("h2",{id:"alarms",children:["Alarms ",i("span",{class:"dim",children:t.
length>0?`${t.length} now`:""})]}),i(tg,{alarm:t[0]}),e.length===0&&(no.version.value===0?i("p",{class:"empty",children:"\
The server has not reported yet."}):i("p",{class:"empty",children:[i(ue,{name:"ended"}),"No alarm now, and none in the l\
ast ten minutes."]})),i("ul",{class:"alarms panel",hidden:e.length===0,children:[e.slice(0,zs).map(n=>i(eg,{alarm:n},n.id)),
e.length>zs&&i("li",{class:"note dim",children:["and ",e.length-zs," more"]}),i(ng,{number:ps.value})]})]})}var jc=120,Hs=22;function og({name:e}){vn.version.value;let t=Fr.get(e)?.rates??[],n=Math.max(1,...t),o=jc-t.length+1,r=t.
map((l,a)=>`${o+a},${(Hs-1-l/n*(Hs-3)).toFixed(1)}`);return i("svg",{class:"trend",viewBox:`0 0 ${jc} ${Hs}`,preserveAspectRatio:"\
none",role:"img","aria-label":`frames a second in the last minute, at most ${Math.round(n)}`,children:r.length>1&&i("pol\
yline",{points:r.join(" ")})})}var Kc=({loss:e})=>i("li",{title:e.help,children:[i("span",{children:e.name.replaceAll("_",
" ")}),i("b",{class:"number",children:ut(e.count)}),e.help&&i("small",{children:e.help})]});function rg({hop:e}){let{count:t,
seconds:n}=hs(e),o=Pl(e),r=rc(e)?"lost or damaged":"lost";return o===0?i("p",{class:"fine",children:[i(ue,{name:"ended"}),
"nothing lost here"]}):i("div",{class:`losses ${t>0?"error":""}`,children:[i("p",{children:[i(ue,{name:t>0?"error":"info"}),
ut(o)," ",r,n>0&&i("span",{class:"end",children:t>0?`+${ut(t)} in ${n} s`:`none in the last ${n} s`})]}),i("ul",{children:e.
losses.map(l=>i(Kc,{loss:l},l.name))})]})}var lg={up:"up",down:"down",ended:"ended"};function ig({link:e}){return i("li",
{class:e.state,children:[i("span",{class:"link",title:e.name,children:[i(ue,{name:lg[e.state]}),i("span",{class:"mono cu\
t",children:e.name}),e.state!=="up"&&` ${e.state}`]}),i("span",{class:"number dim",title:`${Lr(e.bytes_in)} in, ${Lr(e.bytes_out)}\
 out`,children:[i("b",{children:Tt(e.hz_in)})," in ",i("b",{children:Tt(e.hz_out)})," out"]}),e.losses.length>0&&i("ul",
{class:"losses",children:e.losses.map(t=>i(Kc,{loss:t},t.name))})]})}var qc=({name:e,hz:t,frames:n})=>i("div",{children:[
i("dt",{children:e}),i("dd",{children:[i("b",{children:Tt(t)}),i("span",{class:"unit",children:"/s"})]}),i("dd",{class:"\
dim",children:ut(n)})]}),Zc=e=>e.kind==="source"&&e.frames_in+e.frames_out===0,Jc=e=>e.state!=="up"&&e.kind!=="station"&&
!Zc(e),sg=e=>Zc(e)?"waiting":Jc(e)?"down":"not here";function ag({hop:e}){let t=e.state==="up",n=e.name.endsWith(e.kind)?
"":e.kind;return i("header",{children:[i("h3",{children:[i(ue,{name:t?"up":"down"}),i("span",{class:"cut",title:e.name,children:e.
name})]}),i("span",{class:"end dim",children:[i("span",{class:"kind",children:n})," ",t?"":sg(e)]})]})}function ug({hop:e}){
let t=`panel hop ${Jc(e)?"down":""} ${hs(e).count>0?"losing":""}`;return i("li",{class:t,children:[i(ag,{hop:e}),i(og,{name:e.
name}),i("dl",{class:"rates",children:[i(qc,{name:"in",hz:e.hz_in,frames:e.frames_in}),i(qc,{name:"out",hz:e.hz_out,frames:e.
frames_out})]}),i(rg,{hop:e}),e.hint&&i("p",{class:"hint",children:e.hint}),e.links.length>0&&i("ul",{class:"links",children:e.
links.map(n=>i(ig,{link:n},n.name))})]})}var Yc=({all:e})=>i("ol",{class:"hops",children:e.map((t,n)=>[n>0&&i("li",{class:"\
arrow","aria-hidden":"true",children:i(ue,{name:"arrow"})},`to ${t.name}`),i(ug,{hop:t},t.name)])});function Xc(){vn.version.
value;let e=El.value,t=1+e.findIndex(n=>n.kind==="station")||e.length;return i("section",{"aria-labelledby":"hops",children:[
i("h2",{id:"hops",children:["Hops"," ",i("span",{class:"dim",children:e.length>0&&`${t}, in the order in which frames pa\
ss them`})]}),e.length===0&&i("p",{class:"empty",children:"The server has not reported yet."}),i(Yc,{all:e.slice(0,t)}),
t<e.length&&i(te,{children:[i("h3",{class:"aside dim",children:"Beside them, reading along"}),i(Yc,{all:e.slice(t)})]})]})}var cg=6,fg={GPS_FIX_TYPE_NO_GPS:"no GPS",GPS_FIX_TYPE_NO_FIX:"no fix",GPS_FIX_TYPE_2D_FIX:"2D",GPS_FIX_TYPE_3D_FIX:"3D",
GPS_FIX_TYPE_DGPS:"DGPS",GPS_FIX_TYPE_RTK_FLOAT:"RTK float",GPS_FIX_TYPE_RTK_FIXED:"RTK fixed",GPS_FIX_TYPE_STATIC:"stat\
ic",GPS_FIX_TYPE_PPP:"PPP"};function Ws(e){return!e||e.fix===null?"\u2013":fg[e.fix]??Rr(e.fix,"GPS_FIX_TYPE_")}var Qc=e=>[
"no GPS","no fix"].includes(Ws(e)),tf=e=>e?.heading_deg==null?"\u2013":String(Math.round(e.heading_deg)%360);function nf(e){
let t=[["TIMESYNC",e.round_trip_ms?.timesync],["PING",e.round_trip_ms?.ping],["command",e.round_trip_ms?.command]],[n,o]=t.
find(([,r])=>r!=null)??["",null];return o?{text:o.last.toFixed(1),help:`${n}: least ${o.least.toFixed(1)} ms, mean ${o.mean.
toFixed(1)} ms of ${o.count}`}:{text:"\u2013",help:"no TIMESYNC, PING or command has been answered"}}function pg(e){Cn.value=
`${Fn(e)} `,He.value="messages"}var of=({armed:e})=>e===null?i("span",{class:"dim",children:"\u2013"}):i("span",{class:`\
pill ${e?"armed":""}`,children:e?"ARMED":"disarmed"}),rf=e=>e<=15?"error":e<=30?"warning":"";function lf({percent:e}){return e==
null?null:i("svg",{class:`gauge ${rf(e)}`,viewBox:"0 0 100 10",preserveAspectRatio:"none","aria-hidden":"true",children:[
i("rect",{class:"empty",width:"100",height:"10"}),i("rect",{width:Math.max(0,Math.min(100,e)),height:"10"})]})}function sf({
battery:e}){let t=e?.percent;if(t==null)return i(te,{children:"\u2013"});let n=rf(t);return i("span",{class:n,children:[
n!==""&&i(ue,{name:n}),Math.round(t)," %"]})}var af=({all:e})=>{if(e.length===0)return null;let t=["error","warning","in\
fo"].find(n=>e.some(o=>o.severity===n))??"info";return i("span",{class:`mark ${t}`,title:e.map(n=>n.text).join(`
`),children:[i(ue,{name:t}),e.length]})},uf=({one:e})=>i(te,{children:[i("b",{class:"mono",children:Fn(e)})," ",Rr(e.type,
"MAV_TYPE_")]}),Gs=({one:e})=>i("button",{class:"name",onClick:()=>pg(e),title:"Show its messages",children:i(uf,{one:e})}),
ei=I(null),Us=window.matchMedia("(max-width: 1380px)"),Bs=I(Us.matches);Us.addEventListener("change",()=>{Bs.value=Us.matches});
function dg({one:e}){if(!Bs.value)return i(Gs,{one:e});let t=Fn(e),n=ei.value===t;return i("button",{class:"name","aria-\
expanded":n,title:"Show its state",onClick:()=>{ei.value=n?null:t,n||Rn(".panels.one .name")},children:i(uf,{one:e})})}var ti=({
name:e,title:t,children:n})=>i("div",{class:"pair",title:t,children:[i("dt",{children:e}),i("dd",{children:n})]}),bn=({name:e,
value:t,unit:n,help:o})=>i(ti,{name:e,title:o,children:[t,t!=="\u2013"&&i("span",{class:"unit",children:n})]});function mg({
battery:e}){return i(te,{children:[i(ti,{name:"Battery",children:[i(sf,{battery:e}),i(lf,{percent:e?.percent})]}),i(bn,{
name:"Voltage",value:$e(e?.voltage_v,2),unit:"V"}),i(bn,{name:"Current",value:$e(e?.current_a,1),unit:"A"})]})}function hg({
position:e}){return i(te,{children:[i(bn,{name:"Height",help:"above home",value:$e(e?.relative_alt_m,1),unit:"m"}),i(bn,
{name:"Speed",help:"over ground",value:$e(e?.ground_speed_m_s,1),unit:"m/s"}),i(bn,{name:"Heading",value:tf(e),unit:"\xB0"}),
i(bn,{name:"Latitude",value:$e(e?.lat_deg,6),unit:"\xB0"}),i(bn,{name:"Longitude",value:$e(e?.lon_deg,6),unit:"\xB0"}),i(
bn,{name:"Altitude",help:"above mean sea level",value:$e(e?.alt_m,1),unit:"m"})]})}function gg({one:e}){let{battery:t,gps:n,
position:o}=e,r=nf(e);return i("dl",{class:"figures",children:[i(mg,{battery:t}),i(ti,{name:"GPS",children:i("span",{class:Qc(
n)?"warning":"",children:[Qc(n)&&i(ue,{name:"warning"}),Ws(n)]})}),i(ti,{name:"Satellites",children:n?.satellites??"\u2013"}),
i(bn,{name:"Round trip",help:r.help,value:r.text,unit:"ms"}),i(hg,{position:o})]})}function ef({one:e}){let t=ds(e);return i(
"article",{class:`panel vehicle ${e.silent?"silent":""}`,children:[i("header",{children:[i("h3",{children:i(Gs,{one:e})}),
i(af,{all:t}),i("span",{class:"end dim",children:e.silent?i(te,{children:[i(ue,{name:"lost"}),"silent for ",Yt(e.age_s)]}):
`${Tt(e.hz)} /s`})]}),i("p",{class:"mode",children:[i("strong",{children:e.mode??"\u2013"}),i(of,{armed:e.armed}),i("spa\
n",{class:"end dim",children:[Rr(e.status,"MAV_STATE_")," \xB7 ",Rr(e.autopilot,"MAV_AUTOPILOT_")]})]}),i(gg,{one:e})]})}
var vg=[{key:"vehicle",label:"Vehicle",cell:e=>i(dg,{one:e})},{key:"marks",label:"Alarms",cell:e=>i(af,{all:ds(e)})},{key:"\
mode",label:"Mode",cell:e=>e.mode??"\u2013"},{key:"armed",label:"Armed",cell:e=>i(of,{armed:e.armed})},{key:"percent",label:"\
Battery",isNumber:!0,cell:e=>i(te,{children:[i(lf,{percent:e.battery?.percent}),i(sf,{battery:e.battery})]})},{key:"volt\
age",label:"V",isNumber:!0,cell:e=>$e(e.battery?.voltage_v,2)},{key:"fix",label:"GPS",cell:e=>Ws(e.gps)},{key:"satellite\
s",label:"Sats",isNumber:!0,cell:e=>e.gps?.satellites??"\u2013"},{key:"height",label:"Height m",isNumber:!0,cell:e=>$e(e.
position?.relative_alt_m,1)},{key:"speed",label:"m/s",isNumber:!0,cell:e=>$e(e.position?.ground_speed_m_s,1)},{key:"head\
ing",label:"Heading",isNumber:!0,cell:e=>tf(e.position)},{key:"lat",label:"Latitude",isNumber:!0,cell:e=>$e(e.position?.
lat_deg,6)},{key:"lon",label:"Longitude",isNumber:!0,cell:e=>$e(e.position?.lon_deg,6)},{key:"trip",label:"Trip ms",help:"\
round trip",isNumber:!0,cell:e=>nf(e).text},{key:"rate",label:"/s",help:"messages a second",isNumber:!0,cell:e=>Tt(e.hz)},
{key:"age",label:"Age",isNumber:!0,cell:e=>Yt(e.age_s)}];function _g({all:e}){return e.length===0?null:i("ul",{class:"ot\
hers","aria-label":"Other components",children:[e.slice(0,40).map(t=>i("li",{class:t.silent?"silent":"",children:[i(Gs,{
one:t})," ",i("span",{class:"dim",children:t.silent?`silent for ${Yt(t.age_s)}`:`${Tt(t.hz)} /s`})]},Fn(t))),e.length>40&&
i("li",{class:"dim",children:["and ",e.length-40," more"]})]})}function bg({all:e}){let t=Bs.value?e.find(n=>Fn(n)===ei.
value):void 0;return e.length>cg?i(te,{children:[t&&i("div",{class:"panels one",children:i(ef,{one:t})}),i(Yl,{caption:"\
Vehicles",columns:vg,rows:e,keyOf:Fn,current:t?ei.value:null,classOf:n=>`${n.silent?"silent":""} ${n===t?"open":""}`})]}):
i("div",{class:"panels",children:e.map(n=>i(ef,{one:n},Fn(n)))})}function cf(){Nl.version.value,gt.value;let e=Al.value.
filter(ms).sort((n,o)=>n.sys-o.sys||n.comp-o.comp),t=e.filter(n=>n.silent).length;return i("section",{"aria-labelledby":"\
vehicles",children:[i("h2",{id:"vehicles",children:["Vehicles"," ",i("span",{class:"dim",children:[e.length>0&&e.length,
t>0&&`, ${t} silent`]})]}),e.length===0&&i(Xl,{text:"No vehicle has sent a HEARTBEAT yet."}),i(bg,{all:e}),i(_g,{all:Al.
value.filter(n=>!ms(n))})]})}function ff(){return Qe(()=>{let e=[Nl.use(),vn.use(),no.use()];return()=>e.forEach(t=>t())},[]),i(te,{children:[i(cf,{}),
i(Xc,{}),i(Bc,{})]})}var js=2e4;function Hr(e,t,n,o){for(;n<o;){let r=n+o>>1;e[r]<t?n=r+1:o=r}return n}var ni=class{times=new Float64Array(2*
js);values=new Float64Array(2*js);first=0;end=0;get length(){return this.end-this.first}get latest(){return this.end>this.
first?this.values[this.end-1]:NaN}get latestTime(){return this.end>this.first?this.times[this.end-1]:-1/0}add(t,n){this.
end===this.times.length&&this.compact(),this.times[this.end]=t,this.values[this.end++]=n,this.length>js&&++this.first}range(t,n){
let o=Math.max(this.first,Hr(this.times,t,this.first,this.end)-1),r=Math.min(this.end,Hr(this.times,n,this.first,this.end)+
2);return[this.times.subarray(o,r),this.values.subarray(o,r)]}clear(){this.first=this.end=0}compact(){this.times.copyWithin(
0,this.first,this.end),this.values.copyWithin(0,this.first,this.end),this.end-=this.first,this.first=0}};function xg(e,t){
let n=[...Array(t.length+1).keys()];for(let o=0;o<e.length;++o){let r=[o+1];for(let l=0;l<t.length;++l)r.push(Math.min(r[l]+
1,n[l+1]+1,n[l]+(e[o]===t[l]?0:1)));n=r}return n[t.length]}function wg(e,t){let n=t.fields.filter(r=>r.type!=="string").
map(r=>({name:r.name,score:xg(e.toLowerCase(),r.name)-(r.name.startsWith(e)?3:0)}));n.sort((r,l)=>r.score-l.score);let o=n[0];
return o&&o.score<=3?`; is it ${o.name}?`:`; it has ${t.fields.map(r=>r.name).join(", ")}`}function yg({name:e,element:t,
at:n},o){let r=o.fields[o.indexOf.get(e)??-1];if(!r)throw new nt(`${o.name} has no field ${e}${wg(e,o)}`,n);if(r.type===
"string")throw new nt(`${e} is text, not a number`,n);if(r.length!==null&&t===null)throw new nt(`${e} is an array: choos\
e an element, from ${e}[0] to ${e}[${r.length-1}]`,n);if(r.length===null&&t!==null)throw new nt(`${e} is not an array`,n);
if(t!==null&&t>=(r.length??0))throw new nt(`${e} has ${r.length} elements, the last is ${e}[${(r.length??1)-1}]`,n)}function Sg(e,t,n,o){
let r=e.indexOf.get(n)??-1,l=e.fields[r],a=t[r];return l&&a!==void 0&&Kl(l,a,o)?NaN:kc(t,r,o)}var Ur=class{constructor(t,n){
this.parsed=t;this.own=n;let o=new Set(t.uses.map(r=>r.topic??n));this.topics=o.size>0?[...o]:[n]}parsed;own;topics;latest=new Map;check(t){
for(let n of this.parsed.uses){let o=t(n.topic??this.own);o&&yg(n,o)}}take(t,n,o){return this.latest.set(t,{schema:n,message:Gl(
n,o)}),this.latest.size<this.topics.length?null:this.parsed.formula((r,l,a)=>{let c=this.latest.get(a??this.own);return c?
Sg(c.schema,c.message,r,l):NaN})}};function pf(e,t,n){let[,o,r]=e.trim().match(/^(?:(\/\S+)\.)?(\w+)(?:\[\d+\])?$/)??[],
l=n(o??t);return l?.fields[l.indexOf.get(r??"")??-1]?.unit??""}function df(e,t){try{return t||(Ir(e).uses.find(n=>n.topic!==
null)?.topic??"")}catch{return t}}function mf(e,t,n){try{let o=Ir(e),r=o.uses.find(l=>l.topic===null&&t==="");return r?new nt(
`choose a topic, or write it here, as in /1/1/VFR_HUD.${r.name}`,r.at):(new Ur(o,t).check(n),null)}catch(o){if(o instanceof
nt)return o;throw o}}var Zt=I(0),oi=e=>at.get(e)?.schema??null,qs=class{constructor(t,n){this.topic=t;this.formula=n;this.attempt(()=>{let o=new Ur(
Ir(n),t);this.evaluator=o,this.stopWanting=o.topics.map(r=>Uo(r,(l,a)=>this.take(o,r,l,a)))}),this.compile()}topic;formula;points=new ni;fault=null;unit="";total=0;arrivedMs=0;evaluator=null;schemas=[];stopWanting=[];compile(){
let{evaluator:t}=this,n=t?.topics.map(oi)??[];n.every((o,r)=>o===this.schemas[r])||(this.schemas=n,this.attempt(()=>{t?.
check(oi),this.unit=pf(this.formula,this.topic,oi),this.fault=null}))}interrupt(){this.points.length>0&&!Number.isNaN(this.
points.latest)&&this.points.add(this.points.latestTime,NaN)}stop(){for(let t of this.stopWanting)t()}attempt(t){try{t()}catch(n){
this.fault=n instanceof nt?n:new nt(String(n),0)}}take(t,n,o,r){this.compile();let l=oi(n);if(!l||this.fault)return;let a=t.
take(n,l,o);if(a===null)return;let c=r/1e6;c<this.points.latestTime-5&&this.points.clear(),this.points.add(Math.max(c,this.
points.latestTime),a),++this.total,this.arrivedMs=performance.now(),kt(Zt)}},io=new Map,xn=e=>`${e.topic} ${e.formula}`,
cn=e=>io.get(xn(e));function kg(e){let t=new Set(e.map(xn));for(let[n,o]of io)t.has(n)||(o.stop(),io.delete(n));for(let n of e)
io.has(xn(n))||io.set(xn(n),new qs(n.topic,n.formula));kt(Zt)}function hf(){Le(()=>kg(he.value.flat())),Le(()=>{qt.value,
io.forEach(e=>e.compile())}),Le(()=>{ht.value||io.forEach(e=>e.interrupt())})}var It=I(null),Ys=new Map,gf=0,vf=()=>he.value.flat().reduce((e,t)=>e+(cn(t)?.total??0),0),_f=()=>Math.max(0,vf()-gf);function Mg(){
let e=-1/0;for(let t of he.value.flat()){let n=cn(t);if(!n||n.points.length===0)continue;let o=Math.min((performance.now()-
n.arrivedMs)/1e3,Ln.value/2);e=Math.max(e,n.points.latestTime+o)}return Number.isFinite(e)?e:Date.now()/1e3}function Jt(){
let e=Mg();return It.value??{from:e-Ln.value,to:e}}function so(e=Jt()){if(It.value===null){gf=vf();for(let t of he.value.
flat()){let n=cn(t)?.points.range(-1/0,1/0);n&&Ys.set(xn(t),[n[0].slice(),n[1].slice()])}}It.value=e,kt(Zt)}function Wr(){
Ys.clear(),It.value=null,kt(Zt)}function fn(e,t=.5){let{from:n,to:o}=Jt(),r=Math.min(7200,Math.max(.05,(o-n)*e)),l=n+(o-
n)*t;so({from:l-r*t,to:l+r*(1-t)})}function Gr(e){let{from:t,to:n}=Jt(),o=(n-t)*e;so({from:t+o,to:n+o})}function ao(e,{from:t,
to:n}){let o=It.value===null?void 0:Ys.get(xn(e));if(!o)return cn(e)?.points.range(t,n)??[new Float64Array,new Float64Array];
let r=Math.max(0,Hr(o[0],t,0,o[0].length)-1),l=Hr(o[0],n,0,o[0].length)+2;return[o[0].subarray(r,l),o[1].subarray(r,l)]}
function bf([e,t],n){if(e.length<=4*n)return[e,t];let o=[];for(let r=0;r<n;++r){let l=Math.floor(r*e.length/n),a=Math.floor(
(r+1)*e.length/n),c=l,d=l;for(let m=l;m<a;++m)t[m]>=t[c]||(c=m),t[m]<=t[d]||(d=m);for(let m of c<d?[c,d]:[d,c])o.push([e[m],
t[m]])}return[Float64Array.from(o,r=>r[0]),Float64Array.from(o,r=>r[1])]}function xf(e,t){let n=document.createElement("a");n.href=URL.createObjectURL(t),n.download=e,n.click(),setTimeout(()=>URL.
revokeObjectURL(n.href),1e4)}var wf=e=>`mavloom-${new Date().toISOString().slice(0,19).replace("T","-").replaceAll(":","")}\
.${e}`,Tg=e=>/[",\n]/.test(e)?`"${e.replaceAll('"','""')}"`:e;function Ks({topic:e,formula:t,scale:n,offset:o}){let r=n===
1?"":` * ${n}`;return`${e} ${t}${r}${o===0?"":` + ${o}`}`}function Ag(e){let t=new Map,n=Jt();e.forEach((r,l)=>{let[a,c]=ao(
r,n);for(let d=0;d<a.length;++d){let m=a[d],g=c[d];if(m<n.from||m>n.to||Number.isNaN(g))continue;let _=t.get(m)??e.map(()=>"");
_[l]=String(g*r.scale+r.offset),t.set(m,_)}});let o=[...t].sort(([r],[l])=>r-l).map(([r,l])=>[r.toFixed(6),...l].join(","));
return[["time_s",...e.map(r=>Tg(Ks(r)))].join(","),...o,""].join(`
`)}var yf=e=>xf(wf("csv"),new Blob([Ag(e)],{type:"text/csv"}));function Sf(e,t){let n=devicePixelRatio||1,o=24*n,r=document.
createElement("canvas");r.width=e.width,r.height=e.height+o;let l=r.getContext("2d");if(!l)return;l.fillStyle=lo("panel"),
l.fillRect(0,0,r.width,r.height),l.drawImage(e,0,o),l.font=`${12*n}px system-ui, sans-serif`,l.textBaseline="middle";let a=12*
n;t.forEach((c,d)=>{l.fillStyle=lo(`series-${d%Yo}`),l.fillText(Ks(c),a,o/2),a+=l.measureText(Ks(c)).width+24*n}),r.toBlob(
c=>{c&&xf(wf("png"),c)})}var Eg="uplot",Ng="u-hz",Pg="u-vt",Og="u-title",Fg="u-wrap",Cg="u-under",Dg="u-over",Lg="u-axis",fo="u-off",$g="u-select",
Rg="u-cursor-x",Ig="u-cursor-y",Vg="u-cursor-pt",zg="u-legend",Hg="u-live",Ug="u-inline",Wg="u-series",Gg="u-marker",kf="\
u-label",Bg="u-value",jr="width",qr="height";var Mf="bottom",Qo="left",Zs="right",da="#000",Tf=da+"0",Js="mousemove",Af="mousedown",Xs="mouseup",Ef="mouseenter",Nf="\
mouseleave",Pf="dblclick",jg="resize",qg="scroll",Of="change",ai="dppxchange",ma="--",ir=typeof window<"u",oa=ir?document:
null,tr=ir?window:null,Yg=ir?navigator:null,ce,ri;function ra(){let e=devicePixelRatio;ce!=e&&(ce=e,ri&&ia(Of,ri,ra),ri=
matchMedia(`(min-resolution: ${ce-.001}dppx) and (max-resolution: ${ce+.001}dppx)`),po(Of,ri,ra),tr.dispatchEvent(new CustomEvent(
ai)))}function At(e,t){if(t!=null){let n=e.classList;!n.contains(t)&&n.add(t)}}function la(e,t){let n=e.classList;n.contains(
t)&&n.remove(t)}function Se(e,t,n){e.style[t]=n+"px"}function Xt(e,t,n,o){let r=oa.createElement(e);return t!=null&&At(r,
t),n?.insertBefore(r,o),r}function Vt(e,t){return Xt("div",e,t)}var Ff=new WeakMap;function pn(e,t,n,o,r){let l="transla\
te("+t+"px,"+n+"px)",a=Ff.get(e);l!=a&&(e.style.transform=l,Ff.set(e,l),t<0||n<0||t>o||n>r?At(e,fo):la(e,fo))}var Cf=new WeakMap;
function Df(e,t,n){let o=t+n,r=Cf.get(e);o!=r&&(Cf.set(e,o),e.style.background=t,e.style.borderColor=n)}var Lf=new WeakMap;
function $f(e,t,n,o){let r=t+""+n,l=Lf.get(e);r!=l&&(Lf.set(e,r),e.style.height=n+"px",e.style.width=t+"px",e.style.marginLeft=
o?-t/2+"px":0,e.style.marginTop=o?-n/2+"px":0)}var ha={passive:!0},Kg={...ha,capture:!0};function po(e,t,n,o){t.addEventListener(
e,n,o?Kg:ha)}function ia(e,t,n,o){t.removeEventListener(e,n,ha)}ir&&ra();function Qt(e,t,n,o){let r;n=n||0,o=o||t.length-
1;let l=o<=2147483647;for(;o-n>1;)r=l?n+o>>1:Et((n+o)/2),t[r]<e?n=r:o=r;return e-t[n]<=t[o]-e?n:o}function cp(e){return(n,o,r)=>{
let l=-1,a=-1;for(let c=o;c<=r;c++)if(e(n[c])){l=c;break}for(let c=r;c>=o;c--)if(e(n[c])){a=c;break}return[l,a]}}var fp=e=>e!=
null,pp=e=>e!=null&&e>0,fi=cp(fp),Zg=cp(pp);function Jg(e,t,n,o=0,r=!1){let l=r?Zg:fi,a=r?pp:fp;[t,n]=l(e,t,n);let c=e[t],
d=e[t];if(t>-1)if(o==1)c=e[t],d=e[n];else if(o==-1)c=e[n],d=e[t];else for(let m=t;m<=n;m++){let g=e[m];a(g)&&(g<c?c=g:g>
d&&(d=g))}return[c??ge,d??-ge]}function pi(e,t,n,o){let r=Vf(e),l=Vf(t);e==t&&(r==-1?(e*=n,t/=n):(e/=n,t*=n));let a=n==10?
wn:dp,c=r==1?Et:zt,d=l==1?zt:Et,m=c(a(We(e))),g=d(a(We(t))),_=nr(n,m),x=nr(n,g);return n==10&&(m<0&&(_=ve(_,-m)),g<0&&(x=
ve(x,-g))),o||n==2?(e=_*r,t=x*l):(e=vp(e,_),t=di(t,x)),[e,t]}function ga(e,t,n,o){let r=pi(e,t,n,o);return e==0&&(r[0]=0),
t==0&&(r[1]=0),r}var va=.1,Rf={mode:3,pad:va},Kr={pad:0,soft:null,mode:0},Xg={min:Kr,max:Kr};function ui(e,t,n,o){return mi(
n)?If(e,t,n):(Kr.pad=n,Kr.soft=o?0:null,Kr.mode=o?3:0,If(e,t,Xg))}function se(e,t){return e??t}function Qg(e,t,n){for(t=
se(t,0),n=se(n,e.length-1);t<=n;){if(e[t]!=null)return!0;t++}return!1}function If(e,t,n){let o=n.min,r=n.max,l=se(o.pad,
0),a=se(r.pad,0),c=se(o.hard,-ge),d=se(r.hard,ge),m=se(o.soft,ge),g=se(r.soft,-ge),_=se(o.mode,0),x=se(r.mode,0),v=t-e,k=wn(
v),N=ct(We(e),We(t)),E=wn(N),F=We(E-k);(v<1e-24||F>10)&&(v=0,(e==0||t==0)&&(v=1e-24,_==2&&m!=ge&&(l=0),x==2&&g!=-ge&&(a=
0)));let w=v||N||1e3,P=wn(w),S=nr(10,Et(P)),K=w*(v==0?e==0?.1:1:l),$=ve(vp(e-K,S/10),24),Z=e>=m&&(_==1||_==3&&$<=m||_==2&&
$>=m)?m:ge,G=ct(c,$<Z&&e>=Z?Z:en(Z,$)),X=w*(v==0?t==0?.1:1:a),W=ve(di(t+X,S/10),24),A=t<=g&&(x==1||x==3&&W>=g||x==2&&W<=
g)?g:-ge,B=en(d,W>A&&t<=A?A:ct(A,W));return G==B&&G==0&&(B=100),[G,B]}var ev=new Intl.NumberFormat(ir?Yg.language:"en-US"),
_a=e=>ev.format(e),Nt=Math,si=Nt.PI,We=Nt.abs,Et=Nt.floor,Ue=Nt.round,zt=Nt.ceil,en=Nt.min,ct=Nt.max,nr=Nt.pow,Vf=Nt.sign,
wn=Nt.log10,dp=Nt.log2,tv=(e,t=1)=>Nt.sinh(e)*t,Qs=(e,t=1)=>Nt.asinh(e/t),ge=1/0;function zf(e){return(wn((e^e>>31)-(e>>
31))|0)+1}function sa(e,t,n){return en(ct(e,t),n)}function mp(e){return typeof e=="function"}function ne(e){return mp(e)?
e:()=>e}var nv=()=>{},hp=e=>e,gp=(e,t)=>t,ov=e=>null,Hf=e=>!0,Uf=(e,t)=>e==t,rv=/\.\d*?(?=9{6,}|0{6,})/gm,mo=e=>{if(bp(e)||
Vn.has(e))return e;let t=`${e}`,n=t.match(rv);if(n==null)return e;let o=n[0].length-1;if(t.indexOf("e-")!=-1){let[r,l]=t.
split("e");return+`${mo(r)}e${l}`}return ve(e,o)};function uo(e,t){return mo(ve(mo(e/t))*t)}function di(e,t){return mo(zt(
mo(e/t))*t)}function vp(e,t){return mo(Et(mo(e/t))*t)}function ve(e,t=0){if(bp(e))return e;let n=10**t,o=e*n*(1+Number.EPSILON);
return Ue(o)/n}var Vn=new Map;function _p(e){return((""+e).split(".")[1]||"").length}function Jr(e,t,n,o){let r=[],l=o.map(
_p);for(let a=t;a<n;a++){let c=We(a),d=ve(nr(e,a),c);for(let m=0;m<o.length;m++){let g=e==10?+`${o[m]}e${a}`:o[m]*d,_=(a>=
0?0:c)+(a>=l[m]?0:l[m]),x=e==10?g:ve(g,_);r.push(x),Vn.set(x,_)}}return r}var Zr={},ba=[],or=[null,null],In=Array.isArray,
bp=Number.isInteger,lv=e=>e===void 0;function Wf(e){return typeof e=="string"}function mi(e){let t=!1;if(e!=null){let n=e.
constructor;t=n==null||n==Object}return t}function iv(e){return e!=null&&typeof e=="object"}var sv=Object.getPrototypeOf(
Uint8Array),xp="__proto__";function rr(e,t=mi){let n;if(In(e)){let o=e.find(r=>r!=null);if(In(o)||t(o)){n=Array(e.length);
for(let r=0;r<e.length;r++)n[r]=rr(e[r],t)}else n=e.slice()}else if(e instanceof sv)n=e.slice();else if(t(e)){n={};for(let o in e)
o!=xp&&(n[o]=rr(e[o],t))}else n=e;return n}function Re(e){let t=arguments;for(let n=1;n<t.length;n++){let o=t[n];for(let r in o)
r!=xp&&(mi(e[r])?Re(e[r],rr(o[r])):e[r]=rr(o[r]))}return e}var av=0,uv=1,cv=2;function fv(e,t,n){for(let o=0,r,l=-1;o<t.
length;o++){let a=t[o];if(a>l){for(r=a-1;r>=0&&e[r]==null;)e[r--]=null;for(r=a+1;r<n&&e[r]==null;)e[l=r++]=null}}}function pv(e,t){
if(hv(e)){let a=e[0].slice();for(let c=1;c<e.length;c++)a.push(...e[c].slice(1));return gv(a[0])||(a=mv(a)),a}let n=new Set;
for(let a=0;a<e.length;a++){let d=e[a][0],m=d.length;for(let g=0;g<m;g++)n.add(d[g])}let o=[Array.from(n).sort((a,c)=>a-
c)],r=o[0].length,l=new Map;for(let a=0;a<r;a++)l.set(o[0][a],a);for(let a=0;a<e.length;a++){let c=e[a],d=c[0];for(let m=1;m<
c.length;m++){let g=c[m],_=Array(r).fill(void 0),x=t?t[a][m]:uv,v=[];for(let k=0;k<g.length;k++){let N=g[k],E=l.get(d[k]);
N===null?x!=av&&(_[E]=N,x==cv&&v.push(E)):_[E]=N}fv(_,v,r),o.push(_)}}return o}var dv=typeof queueMicrotask>"u"?e=>Promise.
resolve().then(e):queueMicrotask;function mv(e){let t=e[0],n=t.length,o=Array(n);for(let l=0;l<o.length;l++)o[l]=l;o.sort(
(l,a)=>t[l]-t[a]);let r=[];for(let l=0;l<e.length;l++){let a=e[l],c=Array(n);for(let d=0;d<n;d++)c[d]=a[o[d]];r.push(c)}
return r}function hv(e){let t=e[0][0],n=t.length;for(let o=1;o<e.length;o++){let r=e[o][0];if(r.length!=n)return!1;if(r!=
t){for(let l=0;l<n;l++)if(r[l]!=t[l])return!1}}return!0}function gv(e,t=100){let n=e.length;if(n<=1)return!0;let o=0,r=n-
1;for(;o<=r&&e[o]==null;)o++;for(;r>=o&&e[r]==null;)r--;if(r<=o)return!0;let l=ct(1,Et((r-o+1)/t));for(let a=e[o],c=o+l;c<=
r;c+=l){let d=e[c];if(d!=null){if(d<=a)return!1;a=d}}return!0}var wp=["January","February","March","April","May","June",
"July","August","September","October","November","December"],yp=["Sunday","Monday","Tuesday","Wednesday","Thursday","Fri\
day","Saturday"];function Sp(e){return e.slice(0,3)}var vv=yp.map(Sp),_v=wp.map(Sp),bv={MMMM:wp,MMM:_v,WWWW:yp,WWW:vv};function Br(e){
return(e<10?"0":"")+e}function xv(e){return(e<10?"00":e<100?"0":"")+e}var wv={YYYY:e=>e.getFullYear(),YY:e=>(e.getFullYear()+
"").slice(2),MMMM:(e,t)=>t.MMMM[e.getMonth()],MMM:(e,t)=>t.MMM[e.getMonth()],MM:e=>Br(e.getMonth()+1),M:e=>e.getMonth()+
1,DD:e=>Br(e.getDate()),D:e=>e.getDate(),WWWW:(e,t)=>t.WWWW[e.getDay()],WWW:(e,t)=>t.WWW[e.getDay()],HH:e=>Br(e.getHours()),
H:e=>e.getHours(),h:e=>{let t=e.getHours();return t==0?12:t>12?t-12:t},AA:e=>e.getHours()>=12?"PM":"AM",aa:e=>e.getHours()>=
12?"pm":"am",a:e=>e.getHours()>=12?"p":"a",mm:e=>Br(e.getMinutes()),m:e=>e.getMinutes(),ss:e=>Br(e.getSeconds()),s:e=>e.
getSeconds(),fff:e=>xv(e.getMilliseconds())};function xa(e,t){t=t||bv;let n=[],o=/\{([a-z]+)\}|[^{]+/gi,r;for(;r=o.exec(
e);)n.push(r[0][0]=="{"?wv[r[1]]:r[0]);return l=>{let a="";for(let c=0;c<n.length;c++)a+=typeof n[c]=="string"?n[c]:n[c](
l,t);return a}}var yv=new Intl.DateTimeFormat().resolvedOptions().timeZone;function Sv(e,t){let n;return t=="UTC"||t=="E\
tc/UTC"?n=new Date(+e+e.getTimezoneOffset()*6e4):t==yv?n=e:(n=new Date(e.toLocaleString("en-US",{timeZone:t})),n.setMilliseconds(
e.getMilliseconds())),n}var kp=e=>e%1==0,ci=[1,2,2.5,5],kv=Jr(10,-32,0,ci),Mp=Jr(10,0,32,ci),Mv=Mp.filter(kp),co=kv.concat(
Mp),wa=`
`,Tp="{YYYY}",Gf=wa+Tp,Ap="{M}/{D}",Yr=wa+Ap,li=Yr+"/{YY}",Ep="{aa}",Tv="{h}:{mm}",er=Tv+Ep,Bf=wa+er,jf=":{ss}",pe=null;
function Np(e){let t=e*1e3,n=t*60,o=n*60,r=o*24,l=r*30,a=r*365,d=(e==1?Jr(10,0,3,ci).filter(kp):Jr(10,-3,0,ci)).concat([
t,t*5,t*10,t*15,t*30,n,n*5,n*10,n*15,n*30,o,o*2,o*3,o*4,o*6,o*8,o*12,r,r*2,r*3,r*4,r*5,r*6,r*7,r*8,r*9,r*10,r*15,l,l*2,l*
3,l*4,l*6,a,a*2,a*5,a*10,a*25,a*50,a*100]),m=[[a,Tp,pe,pe,pe,pe,pe,pe,1],[r*28,"{MMM}",Gf,pe,pe,pe,pe,pe,1],[r,Ap,Gf,pe,
pe,pe,pe,pe,1],[o,"{h}"+Ep,li,pe,Yr,pe,pe,pe,1],[n,er,li,pe,Yr,pe,pe,pe,1],[t,jf,li+" "+er,pe,Yr+" "+er,pe,Bf,pe,1],[e,jf+
".{fff}",li+" "+er,pe,Yr+" "+er,pe,Bf,pe,1]];function g(_){return(x,v,k,N,E,F)=>{let w=[],P=E>=a,S=E>=l&&E<a,K=_(k),$=ve(
K*e,3),Z=ea(K.getFullYear(),P?0:K.getMonth(),S||P?1:K.getDate()),G=ve(Z*e,3);if(S||P){let X=S?E/l:0,W=P?E/a:0,A=$==G?$:ve(
ea(Z.getFullYear()+W,Z.getMonth()+X,1)*e,3),B=new Date(Ue(A/e)),C=B.getFullYear(),q=B.getMonth();for(let U=0;A<=N;U++){let oe=ea(
C+W*U,q+X*U,1),H=oe-_(ve(oe*e,3));A=ve((+oe+H)*e,3),A<=N&&w.push(A)}}else{let X=E>=r?r:E,W=Et(k)-Et($),A=G+W+di($-G,X);w.
push(A);let B=_(A),C=B.getHours()+B.getMinutes()/n+B.getSeconds()/o,q=E/o,U=x.axes[v]._space,oe=F/U;for(;A=ve(A+E,e==1?0:
3),!(A>N);)if(q>1){let H=Et(ve(C+q,6))%24,le=_(A).getHours()-H;le>1&&(le=-1),A-=le*o,C=(C+q)%24;let de=w[w.length-1];ve(
(A-de)/E,3)*oe>=.7&&w.push(A)}else w.push(A)}return w}}return[d,m,g]}var[Av,Ev,Nv]=Np(1),[Pv,Ov,Fv]=Np(.001);Jr(2,-53,53,
[1]);function qf(e,t){return e.map(n=>n.map((o,r)=>r==0||r==8||o==null?o:t(r==1||n[8]==0?o:n[1]+o)))}function Yf(e,t){return(n,o,r,l,a)=>{
let c=t.find(k=>a>=k[0])||t[t.length-1],d,m,g,_,x,v;return o.map(k=>{let N=e(k),E=N.getFullYear(),F=N.getMonth(),w=N.getDate(),
P=N.getHours(),S=N.getMinutes(),K=N.getSeconds(),$=E!=d&&c[2]||F!=m&&c[3]||w!=g&&c[4]||P!=_&&c[5]||S!=x&&c[6]||K!=v&&c[7]||
c[1];return d=E,m=F,g=w,_=P,x=S,v=K,$(N)})}}function Cv(e,t){let n=xa(t);return(o,r,l,a,c)=>r.map(d=>n(e(d)))}function ea(e,t,n){
return new Date(e,t,n)}function Kf(e,t){return t(e)}var Dv="{YYYY}-{MM}-{DD} {h}:{mm}{aa}";function Zf(e,t){return(n,o,r,l)=>l==
null?ma:t(e(o))}function Lv(e,t){let n=e.series[t];return n.width?n.stroke(e,t):n.points.width?n.points.stroke(e,t):null}
function $v(e,t){return e.series[t].fill(e,t)}var Rv={show:!0,live:!0,isolate:!1,mount:nv,markers:{show:!0,width:2,stroke:Lv,
fill:$v,dash:"solid"},idx:null,idxs:null,values:[]};function Iv(e,t){let n=e.cursor.points,o=Vt(),r=n.size(e,t);Se(o,jr,
r),Se(o,qr,r);let l=r/-2;Se(o,"marginLeft",l),Se(o,"marginTop",l);let a=n.width(e,t,r);return a&&Se(o,"borderWidth",a),o}
function Vv(e,t){let n=e.series[t].points;return n._fill||n._stroke}function zv(e,t){let n=e.series[t].points;return n._stroke||
n._fill}function Hv(e,t){return e.series[t].points.size}var ta=[0,0];function Uv(e,t,n){return ta[0]=t,ta[1]=n,ta}function ii(e,t,n,o=!0){
return r=>{r.button==0&&(!o||r.target==t)&&n(r)}}function na(e,t,n,o=!0){return r=>{(!o||r.target==t)&&n(r)}}var Wv={show:!0,
x:!0,y:!0,lock:!1,move:Uv,points:{one:!1,show:Iv,size:Hv,width:0,stroke:zv,fill:Vv},bind:{mousedown:ii,mouseup:ii,click:ii,
dblclick:ii,mousemove:na,mouseleave:na,mouseenter:na},drag:{setScale:!0,x:!0,y:!1,dist:0,uni:null,click:(e,t)=>{t.stopPropagation(),
t.stopImmediatePropagation()},_x:!1,_y:!1},focus:{dist:(e,t,n,o,r)=>o-r,prox:-1,bias:0},hover:{skip:[void 0],prox:null,bias:0},
left:-10,top:-10,idx:null,dataIdx:null,idxs:null,event:null},Pp={show:!0,stroke:"rgba(0,0,0,0.07)",width:2},ya=Re({},Pp,
{filter:gp}),Op=Re({},ya,{size:10}),Fp=Re({},Pp,{show:!1}),Sa='12px system-ui, -apple-system, "Segoe UI", Roboto, "Helve\
tica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji"',
Cp="bold "+Sa,Dp=1.5,Jf={show:!0,scale:"x",stroke:da,space:50,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Cp,
side:2,grid:ya,ticks:Op,border:Fp,font:Sa,lineGap:Dp,rotate:0},Gv="Value",Bv="Time",Xf={show:!0,scale:"x",auto:!1,sorted:1,
min:ge,max:-ge,idxs:[]};function jv(e,t,n,o,r){return t.map(l=>l==null?"":_a(l))}function qv(e,t,n,o,r,l,a){let c=[],d=Vn.
get(r)||0;n=a?n:ve(di(n,r),d);for(let m=n;m<=o;m=ve(m+r,d))c.push(Object.is(m,-0)?0:m);return c}function aa(e,t,n,o,r,l,a){
let c=[],d=e.scales[e.axes[t].scale].log,m=d==10?wn:dp,g=Et(m(n));r=nr(d,g),d==10&&(r=co[Qt(r,co)]);let _=n,x=r*d;d==10&&
(x=co[Qt(x,co)]);do c.push(_),_=_+r,d==10&&!Vn.has(_)&&(_=ve(_,Vn.get(r))),_>=x&&(r=_,x=r*d,d==10&&(x=co[Qt(x,co)]));while(_<=
o);return c}function Yv(e,t,n,o,r,l,a){let d=e.scales[e.axes[t].scale].asinh,m=o>d?aa(e,t,ct(d,n),o,r):[d],g=o>=0&&n<=0?
[0]:[];return(n<-d?aa(e,t,ct(d,-o),-n,r):[d]).reverse().map(x=>-x).concat(g,m)}var Lp=/./,Kv=/[12357]/,Zv=/[125]/,Qf=/1/,
ua=(e,t,n,o)=>e.map((r,l)=>t==4&&r==0||l%o==0&&n.test(r.toExponential()[r<0?1:0])?r:null);function Jv(e,t,n,o,r){let l=e.
axes[n],a=l.scale,c=e.scales[a],d=e.valToPos,m=l._space,g=d(10,a),_=d(9,a)-g>=m?Lp:d(7,a)-g>=m?Kv:d(5,a)-g>=m?Zv:Qf;if(_==
Qf){let x=We(d(1,a)-g);if(x<m)return ua(t.slice().reverse(),c.distr,_,zt(m/x)).reverse()}return ua(t,c.distr,_,1)}function Xv(e,t,n,o,r){
let l=e.axes[n],a=l.scale,c=l._space,d=e.valToPos,m=We(d(1,a)-d(2,a));return m<c?ua(t.slice().reverse(),3,Lp,zt(c/m)).reverse():
t}function Qv(e,t,n,o){return o==null?ma:t==null?"":_a(t)}var ep={show:!0,scale:"y",stroke:da,space:30,gap:5,alignTo:1,size:50,
labelGap:0,labelSize:30,labelFont:Cp,side:3,grid:ya,ticks:Op,border:Fp,font:Sa,lineGap:Dp,rotate:0};function e0(e,t){let n=3+
(e||1)*2;return ve(n*t,3)}function t0(e,t){let{scale:n,idxs:o}=e.series[0],r=e._data[0],l=e.valToPos(r[o[0]],n,!0),a=e.valToPos(
r[o[1]],n,!0),c=We(a-l),d=e.series[t],m=c/(d.points.space*ce);return o[1]-o[0]<=m}var tp={scale:null,auto:!0,sorted:0,min:ge,
max:-ge},$p=(e,t,n,o,r)=>r,np={show:!0,auto:!0,sorted:0,gaps:$p,alpha:1,facets:[Re({},tp,{scale:"x"}),Re({},tp,{scale:"y"})]},
op={scale:"y",auto:!0,sorted:0,show:!0,spanGaps:!1,gaps:$p,alpha:1,points:{show:t0,filter:null},values:null,min:ge,max:-ge,
idxs:[],path:null,clip:null};function n0(e,t,n,o,r){return n/10}var Rp={time:!0,auto:!0,distr:1,log:10,asinh:1,min:null,
max:null,dir:1,ori:0},o0=Re({},Rp,{time:!1,ori:1}),rp={};function Ip(e,t){let n=rp[e];return n||(n={key:e,plots:[],sub(o){
n.plots.push(o)},unsub(o){n.plots=n.plots.filter(r=>r!=o)},pub(o,r,l,a,c,d,m){for(let g=0;g<n.plots.length;g++)n.plots[g]!=
r&&n.plots[g].pub(o,r,l,a,c,d,m)}},e!=null&&(rp[e]=n)),n}var lr=1,ca=2;function ho(e,t,n){let o=e.mode,r=e.series[t],l=o==
2?e._data[t]:e._data,a=e.scales,c=e.bbox,d=l[0],m=o==2?l[1]:l[t],g=o==2?a[r.facets[0].scale]:a[e.series[0].scale],_=o==2?
a[r.facets[1].scale]:a[r.scale],x=c.left,v=c.top,k=c.width,N=c.height,E=e.valToPosH,F=e.valToPosV;return g.ori==0?n(r,d,
m,g,_,E,F,x,v,k,N,gi,sr,_i,zp,Up):n(r,d,m,g,_,F,E,v,x,N,k,vi,ar,Ta,Hp,Wp)}function ka(e,t){let n=0,o=0,r=se(e.bands,ba);
for(let l=0;l<r.length;l++){let a=r[l];a.series[0]==t?n=a.dir:a.series[1]==t&&(a.dir==1?o|=1:o|=2)}return[n,o==1?-1:o==2?
1:o==3?2:0]}function r0(e,t,n,o,r){let l=e.mode,a=e.series[t],c=l==2?a.facets[1].scale:a.scale,d=e.scales[c];return r==-1?
d.min:r==1?d.max:d.distr==3?d.dir==1?d.min:d.max:0}function yn(e,t,n,o,r,l){return ho(e,t,(a,c,d,m,g,_,x,v,k,N,E)=>{let F=a.
pxRound,w=m.dir*(m.ori==0?1:-1),P=m.ori==0?sr:ar,S,K;w==1?(S=n,K=o):(S=o,K=n);let $=F(_(c[S],m,N,v)),Z=F(x(d[S],g,E,k)),
G=F(_(c[K],m,N,v)),X=F(x(l==1?g.max:g.min,g,E,k)),W=new Path2D(r);return P(W,G,X),P(W,$,X),P(W,$,Z),W})}function hi(e,t,n,o,r,l){
let a=null;if(e.length>0){a=new Path2D;let c=t==0?_i:Ta,d=n;for(let _=0;_<e.length;_++){let x=e[_];if(x[1]>x[0]){let v=x[0]-
d;v>0&&c(a,d,o,v,o+l),d=x[1]}}let m=n+r-d,g=10;m>0&&c(a,d,o-g/2,m,o+l+g)}return a}function l0(e,t,n){let o=e[e.length-1];
o&&o[0]==t?o[1]=n:e.push([t,n])}function Ma(e,t,n,o,r,l,a){let c=[],d=e.length;for(let m=r==1?n:o;m>=n&&m<=o;m+=r)if(t[m]===
null){let _=m,x=m;if(r==1)for(;++m<=o&&t[m]===null;)x=m;else for(;--m>=n&&t[m]===null;)x=m;let v=l(e[_]),k=x==_?v:l(e[x]),
N=_-r;v=a<=0&&N>=0&&N<d?l(e[N]):v;let F=x+r;k=a>=0&&F>=0&&F<d?l(e[F]):k,k>=v&&c.push([v,k])}return c}function lp(e){return e==
0?hp:e==1?Ue:t=>uo(t,e)}function Vp(e){let t=e==0?gi:vi,n=e==0?(r,l,a,c,d,m)=>{r.arcTo(l,a,c,d,m)}:(r,l,a,c,d,m)=>{r.arcTo(
a,l,d,c,m)},o=e==0?(r,l,a,c,d)=>{r.rect(l,a,c,d)}:(r,l,a,c,d)=>{r.rect(a,l,d,c)};return(r,l,a,c,d,m=0,g=0)=>{m==0&&g==0?
o(r,l,a,c,d):(m=en(m,c/2,d/2),g=en(g,c/2,d/2),t(r,l+m,a),n(r,l+c,a,l+c,a+d,m),n(r,l+c,a+d,l,a+d,g),n(r,l,a+d,l,a,g),n(r,
l,a,l+c,a,m),r.closePath())}}var gi=(e,t,n)=>{e.moveTo(t,n)},vi=(e,t,n)=>{e.moveTo(n,t)},sr=(e,t,n)=>{e.lineTo(t,n)},ar=(e,t,n)=>{
e.lineTo(n,t)},_i=Vp(0),Ta=Vp(1),zp=(e,t,n,o,r,l)=>{e.arc(t,n,o,r,l)},Hp=(e,t,n,o,r,l)=>{e.arc(n,t,o,r,l)},Up=(e,t,n,o,r,l,a)=>{
e.bezierCurveTo(t,n,o,r,l,a)},Wp=(e,t,n,o,r,l,a)=>{e.bezierCurveTo(n,t,r,o,a,l)};function Gp(e){return(t,n,o,r,l)=>ho(t,
n,(a,c,d,m,g,_,x,v,k,N,E)=>{let{pxRound:F,points:w}=a,P,S;m.ori==0?(P=gi,S=zp):(P=vi,S=Hp);let K=ve(w.width*ce,3),$=(w.size-
w.width)/2*ce,Z=ve($*2,3),G=new Path2D,X=new Path2D,{left:W,top:A,width:B,height:C}=t.bbox;_i(X,W-Z,A-Z,B+Z*2,C+Z*2);let q=U=>{
if(d[U]!=null){let oe=F(_(c[U],m,N,v)),H=F(x(d[U],g,E,k));P(G,oe+$,H),S(G,oe,H,$,0,si*2)}};if(l)l.forEach(q);else for(let U=o;U<=
r;U++)q(U);return{stroke:K>0?G:null,fill:G,clip:X,flags:lr|ca}})}function Bp(e){return(t,n,o,r,l,a)=>{o!=r&&(l!=o&&a!=o&&
e(t,n,o),l!=r&&a!=r&&e(t,n,r),e(t,n,a))}}var i0=Bp(sr),s0=Bp(ar);function jp(e){let t=se(e?.alignGaps,0);return(n,o,r,l)=>ho(
n,o,(a,c,d,m,g,_,x,v,k,N,E)=>{[r,l]=fi(d,r,l);let F=a.pxRound,w=C=>F(_(C,m,N,v)),P=C=>F(x(C,g,E,k)),S,K;m.ori==0?(S=sr,K=
i0):(S=ar,K=s0);let $=m.dir*(m.ori==0?1:-1),Z={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:lr},G=Z.stroke,
X=!1;if(l-r>=N*4){let C=V=>n.posToVal(V,m.key,!0),q=null,U=null,oe,H,ft,ke=w(c[$==1?r:l]),le=w(c[r]),de=w(c[l]),Q=C($==1?
le+1:de-1);for(let V=$==1?r:l;V>=r&&V<=l;V+=$){let Ie=c[V],Me=($==1?Ie<Q:Ie>Q)?ke:w(Ie),fe=d[V];Me==ke?fe!=null?(H=fe,q==
null?(S(G,Me,P(H)),oe=q=U=H):H<q?q=H:H>U&&(U=H)):fe===null&&(X=!0):(q!=null&&K(G,ke,P(q),P(U),P(oe),P(H)),fe!=null?(H=fe,
S(G,Me,P(H)),q=U=oe=H):(q=U=null,fe===null&&(X=!0)),ke=Me,Q=C(ke+$))}q!=null&&q!=U&&ft!=ke&&K(G,ke,P(q),P(U),P(oe),P(H))}else
for(let C=$==1?r:l;C>=r&&C<=l;C+=$){let q=d[C];q===null?X=!0:q!=null&&S(G,w(c[C]),P(q))}let[A,B]=ka(n,o);if(a.fill!=null||
A!=0){let C=Z.fill=new Path2D(G),q=a.fillTo(n,o,a.min,a.max,A),U=P(q),oe=w(c[r]),H=w(c[l]);$==-1&&([H,oe]=[oe,H]),S(C,H,
U),S(C,oe,U)}if(!a.spanGaps){let C=[];X&&C.push(...Ma(c,d,r,l,$,w,t)),Z.gaps=C=a.gaps(n,o,r,l,C),Z.clip=hi(C,m.ori,v,k,N,
E)}return B!=0&&(Z.band=B==2?[yn(n,o,r,l,G,-1),yn(n,o,r,l,G,1)]:yn(n,o,r,l,G,B)),Z})}function a0(e){let t=se(e.align,1),
n=se(e.ascDesc,!1),o=se(e.alignGaps,0),r=se(e.extend,!1);return(l,a,c,d)=>ho(l,a,(m,g,_,x,v,k,N,E,F,w,P)=>{[c,d]=fi(_,c,
d);let S=m.pxRound,{left:K,width:$}=l.bbox,Z=le=>S(k(le,x,w,E)),G=le=>S(N(le,v,P,F)),X=x.ori==0?sr:ar,W={stroke:new Path2D,
fill:null,clip:null,band:null,gaps:null,flags:lr},A=W.stroke,B=x.dir*(x.ori==0?1:-1),C=G(_[B==1?c:d]),q=Z(g[B==1?c:d]),U=q,
oe=q;r&&t==-1&&(oe=K,X(A,oe,C)),X(A,q,C);for(let le=B==1?c:d;le>=c&&le<=d;le+=B){let de=_[le];if(de==null)continue;let Q=Z(
g[le]),V=G(de);t==1?X(A,Q,C):X(A,U,V),X(A,Q,V),C=V,U=Q}let H=U;r&&t==1&&(H=K+$,X(A,H,C));let[ft,ke]=ka(l,a);if(m.fill!=null||
ft!=0){let le=W.fill=new Path2D(A),de=m.fillTo(l,a,m.min,m.max,ft),Q=G(de);X(le,H,Q),X(le,oe,Q)}if(!m.spanGaps){let le=[];
le.push(...Ma(g,_,c,d,B,Z,o));let de=m.width*ce/2,Q=n||t==1?de:-de,V=n||t==-1?-de:de;le.forEach(Ie=>{Ie[0]+=Q,Ie[1]+=V}),
W.gaps=le=m.gaps(l,a,c,d,le),W.clip=hi(le,x.ori,E,F,w,P)}return ke!=0&&(W.band=ke==2?[yn(l,a,c,d,A,-1),yn(l,a,c,d,A,1)]:
yn(l,a,c,d,A,ke)),W})}function ip(e,t,n,o,r,l,a=ge){if(e.length>1){let c=null;for(let d=0,m=1/0;d<e.length;d++)if(t[d]!==
void 0){if(c!=null){let g=We(e[d]-e[c]);g<m&&(m=g,a=We(n(e[d],o,r,l)-n(e[c],o,r,l)))}c=d}}return a}function u0(e){e=e||Zr;
let t=se(e.size,[.6,ge,1]),n=e.align||0,o=e.gap||0,r=e.radius;r=r==null?[0,0]:typeof r=="number"?[r,0]:r;let l=ne(r),a=1-
t[0],c=se(t[1],ge),d=se(t[2],1),m=se(e.disp,Zr),g=se(e.each,v=>{}),{fill:_,stroke:x}=m;return(v,k,N,E)=>ho(v,k,(F,w,P,S,K,$,Z,G,X,W,A)=>{
let B=F.pxRound,C=n,q=o*ce,U=c*ce,oe=d*ce,H,ft;S.ori==0?[H,ft]=l(v,k):[ft,H]=l(v,k);let ke=S.dir*(S.ori==0?1:-1),le=S.ori==
0?_i:Ta,de=S.ori==0?g:(L,_e,Ve,bo,Un,nn,Wn)=>{g(L,_e,Ve,Un,bo,Wn,nn)},Q=se(v.bands,ba).find(L=>L.series[0]==k),V=Q!=null?
Q.dir:0,Ie=F.fillTo(v,k,F.min,F.max,V),ot=B(Z(Ie,K,A,X)),Me,fe,Ut,bt=W,Ne=B(F.width*ce),tn=!1,dn=null,Pt=null,kn=null,go=null;
_!=null&&(Ne==0||x!=null)&&(tn=!0,dn=_.values(v,k,N,E),Pt=new Map,new Set(dn).forEach(L=>{L!=null&&Pt.set(L,new Path2D)}),
Ne>0&&(kn=x.values(v,k,N,E),go=new Map,new Set(kn).forEach(L=>{L!=null&&go.set(L,new Path2D)})));let{x0:vo,size:cr}=m;if(vo!=
null&&cr!=null){C=1,w=vo.values(v,k,N,E),vo.unit==2&&(w=w.map(Ve=>v.posToVal(G+Ve*W,S.key,!0)));let L=cr.values(v,k,N,E);
cr.unit==2?fe=L[0]*W:fe=$(L[0],S,W,G)-$(0,S,W,G),bt=ip(w,P,$,S,W,G,bt),Ut=bt-fe+q}else bt=ip(w,P,$,S,W,G,bt),Ut=bt*a+q,fe=
bt-Ut;Ut<1&&(Ut=0),Ne>=fe/2&&(Ne=0),Ut<5&&(B=hp);let Qr=Ut>0,zn=bt-Ut-(Qr?Ne:0);fe=B(sa(zn,oe,U)),Me=(C==0?fe/2:C==ke?0:
fe)-C*ke*((C==0?q/2:0)+(Qr?Ne/2:0));let rt={stroke:null,fill:null,clip:null,band:null,gaps:null,flags:0},_o=tn?null:new Path2D,
mn=null;if(Q!=null)mn=v.data[Q.series[1]];else{let{y0:L,y1:_e}=m;L!=null&&_e!=null&&(P=_e.values(v,k,N,E),mn=L.values(v,
k,N,E))}let Hn=H*fe,J=ft*fe;for(let L=ke==1?N:E;L>=N&&L<=E;L+=ke){let _e=P[L];if(_e==null)continue;if(mn!=null){let pt=mn[L]??
0;if(_e-pt==0)continue;ot=Z(pt,K,A,X)}let Ve=S.distr!=2||m!=null?w[L]:L,bo=$(Ve,S,W,G),Un=Z(se(_e,Ie),K,A,X),nn=B(bo-Me),
Wn=B(ct(Un,ot)),xt=B(en(Un,ot)),Ot=Wn-xt;if(_e!=null){let pt=_e<0?J:Hn,Wt=_e<0?Hn:J;tn?(Ne>0&&kn[L]!=null&&le(go.get(kn[L]),
nn,xt+Et(Ne/2),fe,ct(0,Ot-Ne),pt,Wt),dn[L]!=null&&le(Pt.get(dn[L]),nn,xt+Et(Ne/2),fe,ct(0,Ot-Ne),pt,Wt)):le(_o,nn,xt+Et(
Ne/2),fe,ct(0,Ot-Ne),pt,Wt),de(v,k,L,nn-Ne/2,xt,fe+Ne,Ot)}}return Ne>0?rt.stroke=tn?go:_o:tn||(rt._fill=F.width==0?F._fill:
F._stroke??F._fill,rt.width=0),rt.fill=tn?Pt:_o,rt})}function c0(e,t){let n=se(t?.alignGaps,0);return(o,r,l,a)=>ho(o,r,(c,d,m,g,_,x,v,k,N,E,F)=>{
[l,a]=fi(m,l,a);let w=c.pxRound,P=H=>w(x(H,g,E,k)),S=H=>w(v(H,_,F,N)),K,$,Z;g.ori==0?(K=gi,Z=sr,$=Up):(K=vi,Z=ar,$=Wp);let G=g.
dir*(g.ori==0?1:-1),X=P(d[G==1?l:a]),W=X,A=[],B=[];for(let H=G==1?l:a;H>=l&&H<=a;H+=G)if(m[H]!=null){let ke=d[H],le=P(ke);
A.push(W=le),B.push(S(m[H]))}let C={stroke:e(A,B,K,Z,$,w),fill:null,clip:null,band:null,gaps:null,flags:lr},q=C.stroke,[
U,oe]=ka(o,r);if(c.fill!=null||U!=0){let H=C.fill=new Path2D(q),ft=c.fillTo(o,r,c.min,c.max,U),ke=S(ft);Z(H,W,ke),Z(H,X,
ke)}if(!c.spanGaps){let H=[];H.push(...Ma(d,m,l,a,G,P,n)),C.gaps=H=c.gaps(o,r,l,a,H),C.clip=hi(H,g.ori,k,N,E,F)}return oe!=
0&&(C.band=oe==2?[yn(o,r,l,a,q,-1),yn(o,r,l,a,q,1)]:yn(o,r,l,a,q,oe)),C})}function f0(e){return c0(p0,e)}function p0(e,t,n,o,r,l){
let a=e.length;if(a<2)return null;let c=new Path2D;if(n(c,e[0],t[0]),a==2)o(c,e[1],t[1]);else{let d=Array(a),m=Array(a-1),
g=Array(a-1),_=Array(a-1);for(let x=0;x<a-1;x++)g[x]=t[x+1]-t[x],_[x]=e[x+1]-e[x],m[x]=g[x]/_[x];d[0]=m[0];for(let x=1;x<
a-1;x++)m[x]===0||m[x-1]===0||m[x-1]>0!=m[x]>0?d[x]=0:(d[x]=3*(_[x-1]+_[x])/((2*_[x]+_[x-1])/m[x-1]+(_[x]+2*_[x-1])/m[x]),
isFinite(d[x])||(d[x]=0));d[a-1]=m[a-2];for(let x=0;x<a-1;x++)r(c,e[x]+_[x]/3,t[x]+d[x]*_[x]/3,e[x+1]-_[x]/3,t[x+1]-d[x+
1]*_[x]/3,e[x+1],t[x+1])}return c}var fa=new Set;function sp(){for(let e of fa)e.syncRect(!0)}ir&&(po(jg,tr,sp),po(qg,tr,
sp,!0),po(ai,tr,()=>{Ze.pxRatio=ce}));var d0=jp(),m0=Gp();function ap(e,t,n,o){return(o?[e[0],e[1]].concat(e.slice(2)):[
e[0]].concat(e.slice(1))).map((l,a)=>pa(l,a,t,n))}function h0(e,t){return e.map((n,o)=>o==0?{}:Re({},t,n))}function pa(e,t,n,o){
return Re({},t==0?n:o,e)}function qp(e,t,n){return t==null?or:[t,n]}var g0=qp;function v0(e,t,n){return t==null?or:ui(t,
n,va,!0)}function Yp(e,t,n,o){return t==null?or:pi(t,n,e.scales[o].log,!1)}var _0=Yp;function Kp(e,t,n,o){return t==null?
or:ga(t,n,e.scales[o].log,!1)}var b0=Kp;function x0(e,t,n,o,r){let l=ct(zf(e),zf(t)),a=t-e,c=Qt(r/o*a,n);do{let d=n[c],m=o*
d/a;if(m>=r&&l+(d<5?Vn.get(d):0)<=17)return[d,m]}while(++c<n.length);return[0,0]}function up(e){let t,n;return e=e.replace(
/(\d+)px/,(o,r)=>(t=Ue((n=+r)*ce))+"px"),[e,t,n]}function w0(e){e.show&&[e.font,e.labelFont].forEach(t=>{let n=ve(t[2]*ce,
1);t[0]=t[0].replace(/[0-9.]+px/,n+"px"),t[1]=n})}function Ze(e,t,n){let o={mode:se(e.mode,1)},r=o.mode;function l(s,u,f,p){
let h=u.valToPct(s);return p+f*(u.dir==-1?1-h:h)}function a(s,u,f,p){let h=u.valToPct(s);return p+f*(u.dir==-1?h:1-h)}function c(s,u,f,p){
return u.ori==0?l(s,u,f,p):a(s,u,f,p)}o.valToPosH=l,o.valToPosV=a;let d=!1;o.status=0;let m=o.root=Vt(Eg);if(e.id!=null&&
(m.id=e.id),At(m,e.class),e.title){let s=Vt(Og,m);s.textContent=e.title}let g=Xt("canvas"),_=o.ctx=g.getContext("2d"),x=Vt(
Fg,m);po("click",x,s=>{s.target===k&&(be!=Po||Te!=Oo)&&Xe.click(o,s)},!0);let v=o.under=Vt(Cg,x);x.appendChild(g);let k=o.
over=Vt(Dg,x);e=rr(e);let N=+se(e.pxAlign,1),E=lp(N);(e.plugins||[]).forEach(s=>{s.opts&&(e=s.opts(o,e)||e)});let F=e.ms||
.001,w=o.series=r==1?ap(e.series||[],Xf,op,!1):h0(e.series||[null],np),P=o.axes=ap(e.axes||[],Jf,ep,!0),S=o.scales={},K=o.
bands=e.bands||[];K.forEach(s=>{s.fill=ne(s.fill||null),s.dir=se(s.dir,-1)});let $=r==2?w[1].facets[0].scale:w[0].scale,
Z={axes:Nd,series:kd},G=(e.drawOrder||["axes","series"]).map(s=>Z[s]);function X(s){let u=s.distr==3?f=>wn(f>0?f:s.clamp(
o,f,s.min,s.max,s.key)):s.distr==4?f=>Qs(f,s.asinh):s.distr==100?f=>s.fwd(f):f=>f;return f=>{let p=u(f),{_min:h,_max:b}=s,
y=b-h;return(p-h)/y}}function W(s){let u=S[s];if(u==null){let f=(e.scales||Zr)[s]||Zr;if(f.from!=null){W(f.from);let p=Re(
{},S[f.from],f,{key:s});p.valToPct=X(p),S[s]=p}else{u=S[s]=Re({},s==$?Rp:o0,f),u.key=s;let p=u.time,h=u.range,b=In(h);if((s!=
$||r==2&&!p)&&(b&&(h[0]==null||h[1]==null)&&(h={min:h[0]==null?Rf:{mode:1,hard:h[0],soft:h[0]},max:h[1]==null?Rf:{mode:1,
hard:h[1],soft:h[1]}},b=!1),!b&&mi(h))){let y=h;h=(M,T,O)=>T==null?or:ui(T,O,y)}u.range=ne(h||(p?g0:s==$?u.distr==3?_0:u.
distr==4?b0:qp:u.distr==3?Yp:u.distr==4?Kp:v0)),u.auto=ne(b?!1:u.auto),u.clamp=ne(u.clamp||n0),u._min=u._max=null,u.valToPct=
X(u)}}}W("x"),W("y"),r==1&&w.forEach(s=>{W(s.scale)}),P.forEach(s=>{W(s.scale)});for(let s in e.scales)W(s);let A=S[$],B=A.
distr,C,q;A.ori==0?(At(m,Ng),C=l,q=a):(At(m,Pg),C=a,q=l);let U={};for(let s in S){let u=S[s];(u.min!=null||u.max!=null)&&
(U[s]={min:u.min,max:u.max},u.min=u.max=null)}let oe=e.tzDate||(s=>new Date(Ue(s/F))),H=e.fmtDate||xa,ft=F==1?Nv(oe):Fv(
oe),ke=Yf(oe,qf(F==1?Ev:Ov,H)),le=Zf(oe,Kf(Dv,H)),de=[],Q=o.legend=Re({},Rv,e.legend),V=o.cursor=Re({},Wv,{drag:{y:r==2}},
e.cursor),Ie=Q.show,ot=V.show,Me=Q.markers;Q.idxs=de,Me.width=ne(Me.width),Me.dash=ne(Me.dash),Me.stroke=ne(Me.stroke),Me.
fill=ne(Me.fill);let fe,Ut,bt,Ne=[],tn=[],dn,Pt=!1,kn={};if(Q.live){let s=w[1]?w[1].values:null;Pt=s!=null,dn=Pt?s(o,1,0):
{_:0};for(let u in dn)kn[u]=ma}if(Ie)if(fe=Xt("table",zg,m),bt=Xt("tbody",null,fe),Q.mount(o,fe),Pt){Ut=Xt("thead",null,
fe,bt);let s=Xt("tr",null,Ut);Xt("th",null,s);for(var go in dn)Xt("th",kf,s).textContent=go}else At(fe,Ug),Q.live&&At(fe,
Hg);let vo={show:!0},cr={show:!1};function Qr(s,u){if(u==0&&(Pt||!Q.live||r==2))return or;let f=[],p=Xt("tr",Wg,bt,bt.childNodes[u]);
At(p,s.class),s.show||At(p,fo);let h=Xt("th",null,p);if(Me.show){let M=Vt(Gg,h);if(u>0){let T=Me.width(o,u);T&&(M.style.
border=T+"px "+Me.dash(o,u)+" "+Me.stroke(o,u)),M.style.background=Me.fill(o,u)}}let b=Vt(kf,h);s.label instanceof HTMLElement?
b.appendChild(s.label):b.textContent=s.label,u>0&&(Me.show||(b.style.color=s.width>0?Me.stroke(o,u):Me.fill(o,u)),rt("cl\
ick",h,M=>{if(V._lock)return;Bn(M);let T=w.indexOf(s);if((M.ctrlKey||M.metaKey)!=Q.isolate){let O=w.some((D,R)=>R>0&&R!=
T&&D.show);w.forEach((D,R)=>{R>0&&rn(R,O?R==T?vo:cr:vo,!0,Ce.setSeries)})}else rn(T,{show:!s.show},!0,Ce.setSeries)},!1),
wo&&rt(Ef,h,M=>{V._lock||(Bn(M),rn(w.indexOf(s),Co,!0,Ce.setSeries))},!1));for(var y in dn){let M=Xt("td",Bg,p);M.textContent=
"--",f.push(M)}return[p,f]}let zn=new Map;function rt(s,u,f,p=!0){let h=zn.get(u)||{},b=V.bind[s](o,u,f,p);b&&(po(s,u,h[s]=
b),zn.set(u,h))}function _o(s,u,f){let p=zn.get(u)||{};for(let h in p)(s==null||h==s)&&(ia(h,u,p[h]),delete p[h]);s==null&&
zn.delete(u)}let mn=0,Hn=0,J=0,L=0,_e=0,Ve=0,bo=_e,Un=Ve,nn=J,Wn=L,xt=0,Ot=0,pt=0,Wt=0;o.bbox={};let Si=!1,el=!1,xo=!1,Gn=!1,
tl=!1,Ft=!1;function ki(s,u,f){(f||s!=o.width||u!=o.height)&&Ca(s,u),To(!1),xo=!0,el=!0,Ao()}function Ca(s,u){o.width=mn=
J=s,o.height=Hn=L=u,_e=Ve=0,vd(),_d();let f=o.bbox;xt=f.left=uo(_e*ce,.5),Ot=f.top=uo(Ve*ce,.5),pt=f.width=uo(J*ce,.5),Wt=
f.height=uo(L*ce,.5)}let md=3;function hd(){let s=!1,u=0;for(;!s;){u++;let f=Ad(u),p=Ed(u);s=u==md||f&&p,s||(Ca(o.width,
o.height),el=!0)}}function gd({width:s,height:u}){ki(s,u)}o.setSize=gd;function vd(){let s=!1,u=!1,f=!1,p=!1;P.forEach((h,b)=>{
if(h.show&&h._show){let{side:y,_size:M}=h,T=y%2,O=h.label!=null?h.labelSize:0,D=M+O;D>0&&(T?(J-=D,y==3?(_e+=D,p=!0):f=!0):
(L-=D,y==0?(Ve+=D,s=!0):u=!0))}}),jn[0]=s,jn[1]=f,jn[2]=u,jn[3]=p,J-=Mn[1]+Mn[3],_e+=Mn[3],L-=Mn[2]+Mn[0],Ve+=Mn[0]}function _d(){
let s=_e+J,u=Ve+L,f=_e,p=Ve;function h(b,y){switch(b){case 1:return s+=y,s-y;case 2:return u+=y,u-y;case 3:return f-=y,f+
y;case 0:return p-=y,p+y}}P.forEach((b,y)=>{if(b.show&&b._show){let M=b.side;b._pos=h(M,b._size),b.label!=null&&(b._lpos=
h(M,b.labelSize))}})}if(V.dataIdx==null){let s=V.hover,u=s.skip=new Set(s.skip??[]);u.add(void 0);let f=s.prox=ne(s.prox),
p=s.bias??=0;V.dataIdx=(h,b,y,M)=>{if(b==0)return y;let T=y,O=f(h,b,y,M)??ge,D=O>=0&&O<ge,R=A.ori==0?J:L,Y=V.left,ae=t[0],
ie=t[b];if(u.has(ie[y])){T=null;let ee=null,j=null,z;if(p==0||p==-1)for(z=y;ee==null&&z-- >0;)u.has(ie[z])||(ee=z);if(p==
0||p==1)for(z=y;j==null&&z++<ie.length;)u.has(ie[z])||(j=z);if(ee!=null||j!=null)if(D){let we=ee==null?-1/0:C(ae[ee],A,R,
0),Pe=j==null?1/0:C(ae[j],A,R,0),Ke=Y-we,me=Pe-Y;Ke<=me?Ke<=O&&(T=ee):me<=O&&(T=j)}else T=j==null?ee:ee==null?j:y-ee<=j-
y?ee:j}else D&&We(Y-C(ae[y],A,R,0))>O&&(T=null);return T}}let Bn=s=>{V.event=s};V.idxs=de,V._lock=!1;let tt=V.points;tt.
show=ne(tt.show),tt.size=ne(tt.size),tt.stroke=ne(tt.stroke),tt.width=ne(tt.width),tt.fill=ne(tt.fill);let on=o.focus=Re(
{},e.focus||{alpha:.3},V.focus),wo=on.prox>=0,yo=wo&&tt.one,Ct=[],So=[],ko=[];function Da(s,u){let f=tt.show(o,u);if(f instanceof
HTMLElement)return At(f,Vg),At(f,s.class),pn(f,-10,-10,J,L),k.insertBefore(f,Ct[u]),f}function La(s,u){if(r==1||u>0){let f=r==
1&&S[s.scale].time,p=s.value;s.value=f?Wf(p)?Zf(oe,Kf(p,H)):p||le:p||Qv,s.label=s.label||(f?Bv:Gv)}if(yo||u>0){s.width=s.
width==null?1:s.width,s.paths=s.paths||d0||ov,s.fillTo=ne(s.fillTo||r0),s.pxAlign=+se(s.pxAlign,N),s.pxRound=lp(s.pxAlign),
s.stroke=ne(s.stroke||null),s.fill=ne(s.fill||null),s._stroke=s._fill=s._paths=s._focus=null;let f=e0(ct(1,s.width),1),p=s.
points=Re({},{size:f,width:ct(1,f*.2),stroke:s.stroke,space:f*2,paths:m0,_stroke:null,_fill:null},s.points);p.show=ne(p.
show),p.filter=ne(p.filter),p.fill=ne(p.fill),p.stroke=ne(p.stroke),p.paths=ne(p.paths),p.pxAlign=s.pxAlign}if(Ie){let f=Qr(
s,u);Ne.splice(u,0,f[0]),tn.splice(u,0,f[1]),Q.values.push(null)}if(ot){de.splice(u,0,null);let f=null;yo?u==0&&(f=Da(s,
u)):u>0&&(f=Da(s,u)),Ct.splice(u,0,f),So.splice(u,0,0),ko.splice(u,0,0)}Ye("addSeries",u)}function bd(s,u){u=u??w.length,
s=r==1?pa(s,u,Xf,op):pa(s,u,{},np),w.splice(u,0,s),La(w[u],u)}o.addSeries=bd;function xd(s){if(w.splice(s,1),Ie){Q.values.
splice(s,1),tn.splice(s,1);let u=Ne.splice(s,1)[0];_o(null,u.firstChild),u.remove()}ot&&(de.splice(s,1),Ct.splice(s,1)[0].
remove(),So.splice(s,1),ko.splice(s,1)),Ye("delSeries",s)}o.delSeries=xd;let jn=[!1,!1,!1,!1];function wd(s,u){if(s._show=
s.show,s.show){let f=s.side%2,p=S[s.scale];p==null&&(s.scale=f?w[1].scale:$,p=S[s.scale]);let h=p.time;s.size=ne(s.size),
s.space=ne(s.space),s.rotate=ne(s.rotate),In(s.incrs)&&s.incrs.forEach(y=>{!Vn.has(y)&&Vn.set(y,_p(y))}),s.incrs=ne(s.incrs||
(p.distr==2?Mv:h?F==1?Av:Pv:co)),s.splits=ne(s.splits||(h&&p.distr==1?ft:p.distr==3?aa:p.distr==4?Yv:qv)),s.stroke=ne(s.
stroke),s.grid.stroke=ne(s.grid.stroke),s.ticks.stroke=ne(s.ticks.stroke),s.border.stroke=ne(s.border.stroke);let b=s.values;
s.values=In(b)&&!In(b[0])?ne(b):h?In(b)?Yf(oe,qf(b,H)):Wf(b)?Cv(oe,b):b||ke:b||jv,s.filter=ne(s.filter||(p.distr>=3&&p.log==
10?Jv:p.distr==3&&p.log==2?Xv:gp)),s.font=up(s.font),s.labelFont=up(s.labelFont),s._size=s.size(o,null,u,0),s._space=s._rotate=
s._incrs=s._found=s._splits=s._values=null,s._size>0&&(jn[u]=!0,s._el=Vt(Lg,x))}}function fr(s,u,f,p){let[h,b,y,M]=f,T=u%
2,O=0;return T==0&&(M||b)&&(O=u==0&&!h||u==2&&!y?Ue(Jf.size/3):0),T==1&&(h||y)&&(O=u==1&&!b||u==3&&!M?Ue(ep.size/2):0),O}
let $a=o.padding=(e.padding||[fr,fr,fr,fr]).map(s=>ne(se(s,fr))),Mn=o._padding=$a.map((s,u)=>s(o,u,jn,0)),Je,Ge=null,Be=null,
nl=r==1?w[0].idxs:null,Gt=null,pr=!1;function Ra(s,u){if(t=s??[],o.data=o._data=t,r==2){Je=0;for(let f=1;f<w.length;f++)
Je+=t[f][0].length}else{t.length==0&&(o.data=o._data=t=[[]]),Gt=t[0],Je=Gt.length;let f=t;if(B==2){f=t.slice();let p=f[0]=
Array(Je);for(let h=0;h<Je;h++)p[h]=h}o._data=t=f}if(To(!0),Ye("setData"),B==2&&(xo=!0),u!==!1){let f=A;f.auto(o,pr)?Mi():
An($,f.min,f.max),Gn=Gn||V.left>=0,Ft=!0,Ao()}}o.setData=Ra;function Mi(){pr=!0;let s,u;r==1&&(Je>0?(Ge=nl[0]=0,Be=nl[1]=
Je-1,s=t[0][Ge],u=t[0][Be],B==2?(s=Ge,u=Be):s==u&&(B==3?[s,u]=pi(s,s,A.log,!1):B==4?[s,u]=ga(s,s,A.log,!1):A.time?u=s+Ue(
86400/F):[s,u]=ui(s,u,va,!0))):(Ge=nl[0]=s=null,Be=nl[1]=u=null)),An($,s,u)}let ol,Mo,Ti,Ai,Ei,Ni,Pi,Oi,Fi,dt;function Ia(s,u,f,p,h,b){
s??=Tf,f??=ba,p??="butt",h??=Tf,b??="round",s!=ol&&(_.strokeStyle=ol=s),h!=Mo&&(_.fillStyle=Mo=h),u!=Ti&&(_.lineWidth=Ti=
u),b!=Ei&&(_.lineJoin=Ei=b),p!=Ni&&(_.lineCap=Ni=p),f!=Ai&&_.setLineDash(Ai=f)}function Va(s,u,f,p){u!=Mo&&(_.fillStyle=
Mo=u),s!=Pi&&(_.font=Pi=s),f!=Oi&&(_.textAlign=Oi=f),p!=Fi&&(_.textBaseline=Fi=p)}function Ci(s,u,f,p,h=0){if(p.length>0&&
s.auto(o,pr)&&(u==null||u.min==null)){let b=se(Ge,0),y=se(Be,p.length-1),M=f.min==null?Jg(p,b,y,h,s.distr==3):[f.min,f.max];
s.min=en(s.min,f.min=M[0]),s.max=ct(s.max,f.max=M[1])}}let za={min:null,max:null};function yd(){for(let p in S){let h=S[p];
U[p]==null&&(h.min==null||U[$]!=null&&h.auto(o,pr))&&(U[p]=za)}for(let p in S){let h=S[p];U[p]==null&&h.from!=null&&U[h.
from]!=null&&(U[p]=za)}U[$]!=null&&To(!0);let s={};for(let p in U){let h=U[p];if(h!=null){let b=s[p]=rr(S[p],iv);if(h.min!=
null)Re(b,h);else if(p!=$||r==2)if(Je==0&&b.from==null){let y=b.range(o,null,null,p);b.min=y[0],b.max=y[1]}else b.min=ge,
b.max=-ge}}if(Je>0){w.forEach((p,h)=>{if(r==1){let b=p.scale,y=U[b];if(y==null)return;let M=s[b];if(h==0){let T=M.range(
o,M.min,M.max,b);M.min=T[0],M.max=T[1],Ge=Qt(M.min,t[0]),Be=Qt(M.max,t[0]),Be-Ge>1&&(t[0][Ge]<M.min&&Ge++,t[0][Be]>M.max&&
Be--),p.min=Gt[Ge],p.max=Gt[Be]}else p.show&&p.auto&&Ci(M,y,p,t[h],p.sorted);p.idxs[0]=Ge,p.idxs[1]=Be}else if(h>0&&p.show&&
p.auto){let[b,y]=p.facets,M=b.scale,T=y.scale,[O,D]=t[h],R=s[M],Y=s[T];R!=null&&Ci(R,U[M],b,O,b.sorted),Y!=null&&Ci(Y,U[T],
y,D,y.sorted),p.min=y.min,p.max=y.max}});for(let p in s){let h=s[p],b=U[p];if(h.from==null&&(b==null||b.min==null)){let y=h.
range(o,h.min==ge?null:h.min,h.max==-ge?null:h.max,p);h.min=y[0],h.max=y[1]}}}for(let p in s){let h=s[p];if(h.from!=null){
let b=s[h.from];if(b.min==null)h.min=h.max=null;else{let y=h.range(o,b.min,b.max,p);h.min=y[0],h.max=y[1]}}}let u={},f=!1;
for(let p in s){let h=s[p],b=S[p];if(b.min!=h.min||b.max!=h.max){b.min=h.min,b.max=h.max;let y=b.distr;b._min=y==3?wn(b.
min):y==4?Qs(b.min,b.asinh):y==100?b.fwd(b.min):b.min,b._max=y==3?wn(b.max):y==4?Qs(b.max,b.asinh):y==100?b.fwd(b.max):b.
max,u[p]=f=!0}}if(f){w.forEach((p,h)=>{r==2?h>0&&u.y&&(p._paths=null):u[p.scale]&&(p._paths=null)});for(let p in u)xo=!0,
Ye("setScale",p);ot&&V.left>=0&&(Gn=Ft=!0)}for(let p in U)U[p]=null}function Sd(s){let u=sa(Ge-1,0,Je-1),f=sa(Be+1,0,Je-
1);for(;s[u]==null&&u>0;)u--;for(;s[f]==null&&f<Je-1;)f++;return[u,f]}function kd(){if(Je>0){let s=w.some(u=>u._focus)&&
dt!=on.alpha;s&&(_.globalAlpha=dt=on.alpha),w.forEach((u,f)=>{if(f>0&&u.show&&(Ha(f,!1),Ha(f,!0),u._paths==null)){let p=dt;
dt!=u.alpha&&(_.globalAlpha=dt=u.alpha);let h=r==2?[0,t[f][0].length-1]:Sd(t[f]);u._paths=u.paths(o,f,h[0],h[1]),dt!=p&&
(_.globalAlpha=dt=p)}}),w.forEach((u,f)=>{if(f>0&&u.show){let p=dt;dt!=u.alpha&&(_.globalAlpha=dt=u.alpha),u._paths!=null&&
Ua(f,!1);{let h=u._paths!=null?u._paths.gaps:null,b=u.points.show(o,f,Ge,Be,h),y=u.points.filter(o,f,b,h);(b||y)&&(u.points.
_paths=u.points.paths(o,f,Ge,Be,y),Ua(f,!0))}dt!=p&&(_.globalAlpha=dt=p),Ye("drawSeries",f)}}),s&&(_.globalAlpha=dt=1)}}
function Ha(s,u){let f=u?w[s].points:w[s];f._stroke=f.stroke(o,s),f._fill=f.fill(o,s)}function Ua(s,u){let f=u?w[s].points:
w[s],{stroke:p,fill:h,clip:b,flags:y,_stroke:M=f._stroke,_fill:T=f._fill,_width:O=f.width}=f._paths;O=ve(O*ce,3);let D=null,
R=O%2/2;u&&T==null&&(T=O>0?"#fff":M);let Y=f.pxAlign==1&&R>0;if(Y&&_.translate(R,R),!u){let ae=xt-O/2,ie=Ot-O/2,ee=pt+O,
j=Wt+O;D=new Path2D,D.rect(ae,ie,ee,j)}u?Di(M,O,f.dash,f.cap,T,p,h,y,b):Md(s,M,O,f.dash,f.cap,T,p,h,y,D,b),Y&&_.translate(
-R,-R)}function Md(s,u,f,p,h,b,y,M,T,O,D){let R=!1;T!=0&&K.forEach((Y,ae)=>{if(Y.series[0]==s){let ie=w[Y.series[1]],ee=t[Y.
series[1]],j=(ie._paths||Zr).band;In(j)&&(j=Y.dir==1?j[0]:j[1]);let z,we=null;ie.show&&j&&Qg(ee,Ge,Be)?(we=Y.fill(o,ae)||
b,z=ie._paths.clip):j=null,Di(u,f,p,h,we,y,M,T,O,D,z,j),R=!0}}),R||Di(u,f,p,h,b,y,M,T,O,D)}let Wa=lr|ca;function Di(s,u,f,p,h,b,y,M,T,O,D,R){
Ia(s,u,f,p,h),(T||O||R)&&(_.save(),T&&_.clip(T),O&&_.clip(O)),R?(M&Wa)==Wa?(_.clip(R),D&&_.clip(D),ll(h,y),rl(s,b,u)):M&
ca?(ll(h,y),_.clip(R),rl(s,b,u)):M&lr&&(_.save(),_.clip(R),D&&_.clip(D),ll(h,y),_.restore(),rl(s,b,u)):(ll(h,y),rl(s,b,u)),
(T||O||R)&&_.restore()}function rl(s,u,f){f>0&&(u instanceof Map?u.forEach((p,h)=>{_.strokeStyle=ol=h,_.stroke(p)}):u!=null&&
s&&_.stroke(u))}function ll(s,u){u instanceof Map?u.forEach((f,p)=>{_.fillStyle=Mo=p,_.fill(f)}):u!=null&&s&&_.fill(u)}function Td(s,u,f,p){
let h=P[s],b;if(p<=0)b=[0,0];else{let y=h._space=h.space(o,s,u,f,p),M=h._incrs=h.incrs(o,s,u,f,p,y);b=x0(u,f,M,p,y)}return h.
_found=b}function Li(s,u,f,p,h,b,y,M,T,O){let D=y%2/2;N==1&&_.translate(D,D),Ia(M,y,T,O,M),_.beginPath();let R,Y,ae,ie,ee=h+
(p==0||p==3?-b:b);f==0?(Y=h,ie=ee):(R=h,ae=ee);for(let j=0;j<s.length;j++)u[j]!=null&&(f==0?R=ae=s[j]:Y=ie=s[j],_.moveTo(
R,Y),_.lineTo(ae,ie));_.stroke(),N==1&&_.translate(-D,-D)}function Ad(s){let u=!0;return P.forEach((f,p)=>{if(!f.show)return;
let h=S[f.scale];if(h.min==null){f._show&&(u=!1,f._show=!1,To(!1));return}else f._show||(u=!1,f._show=!0,To(!1));let b=f.
side,y=b%2,{min:M,max:T}=h,[O,D]=Td(p,M,T,y==0?J:L);if(D==0)return;let R=h.distr==2,Y=f._splits=f.splits(o,p,M,T,O,D,R),
ae=h.distr==2?Y.map(z=>Gt[z]):Y,ie=h.distr==2?Gt[Y[1]]-Gt[Y[0]]:O,ee=f._values=f.values(o,f.filter(o,ae,p,D,ie),p,D,ie);
f._rotate=b==2?f.rotate(o,ee,p,D):0;let j=f._size;f._size=zt(f.size(o,ee,p,s)),j!=null&&f._size!=j&&(u=!1)}),u}function Ed(s){
let u=!0;return $a.forEach((f,p)=>{let h=f(o,p,jn,s);h!=Mn[p]&&(u=!1),Mn[p]=h}),u}function Nd(){for(let s=0;s<P.length;s++){
let u=P[s];if(!u.show||!u._show)continue;let f=u.side,p=f%2,h,b,y=u.stroke(o,s),M=f==0||f==3?-1:1,[T,O]=u._found;if(u.label!=
null){let it=u.labelGap*M,St=Ue((u._lpos+it)*ce);Va(u.labelFont[0],y,"center",f==2?"top":Mf),_.save(),p==1?(h=b=0,_.translate(
St,Ue(Ot+Wt/2)),_.rotate((f==3?-si:si)/2)):(h=Ue(xt+pt/2),b=St);let Kn=mp(u.label)?u.label(o,s,T,O):u.label;_.fillText(Kn,
h,b),_.restore()}if(O==0)continue;let D=S[u.scale],R=p==0?pt:Wt,Y=p==0?xt:Ot,ae=u._splits,ie=D.distr==2?ae.map(it=>Gt[it]):
ae,ee=D.distr==2?Gt[ae[1]]-Gt[ae[0]]:T,j=u.ticks,z=u.border,we=j.show?j.size:0,Pe=Ue(we*ce),Ke=Ue((u.alignTo==2?u._size-
we-u.gap:u.gap)*ce),me=u._rotate*-si/180,Oe=E(u._pos*ce),wt=(Pe+Ke)*M,lt=Oe+wt;b=p==0?lt:0,h=p==1?lt:0;let Dt=u.font[0],
Bt=u.align==1?Qo:u.align==2?Zs:me>0?Qo:me<0?Zs:p==0?"center":f==3?Zs:Qo,sn=me||p==1?"middle":f==2?"top":Mf;Va(Dt,y,Bt,sn);
let yt=u.font[1]*u.lineGap,Lt=ae.map(it=>E(c(it,D,R,Y))),jt=u._values;for(let it=0;it<jt.length;it++){let St=jt[it];if(St!=
null){p==0?h=Lt[it]:b=Lt[it],St=""+St;let Kn=St.indexOf(`
`)==-1?[St]:St.split(/\n/gm);for(let st=0;st<Kn.length;st++){let au=Kn[st];me?(_.save(),_.translate(h,b+st*yt),_.rotate(
me),_.fillText(au,0,0),_.restore()):_.fillText(au,h,b+st*yt)}}}j.show&&Li(Lt,j.filter(o,ie,s,O,ee),p,f,Oe,Pe,ve(j.width*
ce,3),j.stroke(o,s),j.dash,j.cap);let an=u.grid;an.show&&Li(Lt,an.filter(o,ie,s,O,ee),p,p==0?2:1,p==0?Ot:xt,p==0?Wt:pt,ve(
an.width*ce,3),an.stroke(o,s),an.dash,an.cap),z.show&&Li([Oe],[1],p==0?1:0,p==0?1:2,p==1?Ot:xt,p==1?Wt:pt,ve(z.width*ce,
3),z.stroke(o,s),z.dash,z.cap)}Ye("drawAxes")}function To(s){w.forEach((u,f)=>{f>0&&(u._paths=null,s&&(r==1?(u.min=null,
u.max=null):u.facets.forEach(p=>{p.min=null,p.max=null})))})}let il=!1,$i=!1,dr=[];function Pd(){$i=!1;for(let s=0;s<dr.
length;s++)Ye(...dr[s]);dr.length=0}function Ao(){il||(dv(Ga),il=!0)}function Od(s,u=!1){il=!0,$i=u,s(o),Ga(),u&&dr.length>
0&&queueMicrotask(Pd)}o.batch=Od;function Ga(){if(Si&&(yd(),Si=!1),xo&&(hd(),xo=!1),el){if(Se(v,Qo,_e),Se(v,"top",Ve),Se(
v,jr,J),Se(v,qr,L),Se(k,Qo,_e),Se(k,"top",Ve),Se(k,jr,J),Se(k,qr,L),Se(x,jr,mn),Se(x,qr,Hn),g.width=Ue(mn*ce),g.height=Ue(
Hn*ce),P.forEach(({_el:s,_show:u,_size:f,_pos:p,side:h})=>{if(s!=null)if(u){let b=h===3||h===0?f:0,y=h%2==1;Se(s,y?"left":
"top",p-b),Se(s,y?"width":"height",f),Se(s,y?"top":"left",y?Ve:_e),Se(s,y?"height":"width",y?L:J),la(s,fo)}else At(s,fo)}),
ol=Mo=Ti=Ei=Ni=Pi=Oi=Fi=Ai=null,dt=1,gr(!0),_e!=bo||Ve!=Un||J!=nn||L!=Wn){To(!1);let s=J/nn,u=L/Wn;if(ot&&!Gn&&V.left>=0){
V.left*=s,V.top*=u,Eo&&pn(Eo,Ue(V.left),0,J,L),No&&pn(No,0,Ue(V.top),J,L);for(let f=0;f<Ct.length;f++){let p=Ct[f];p!=null&&
(So[f]*=s,ko[f]*=u,pn(p,zt(So[f]),zt(ko[f]),J,L))}}if(xe.show&&!tl&&xe.left>=0&&xe.width>0){xe.left*=s,xe.width*=s,xe.top*=
u,xe.height*=u;for(let f in Ui)Se(Fo,f,xe[f])}bo=_e,Un=Ve,nn=J,Wn=L}Ye("setSize"),el=!1}mn>0&&Hn>0&&(_.clearRect(0,0,g.width,
g.height),Ye("drawClear"),G.forEach(s=>s()),Ye("draw")),xe.show&&tl&&(sl(xe),tl=!1),ot&&Gn&&(Yn(null,!0,!1),Gn=!1),Q.show&&
Q.live&&Ft&&(zi(),Ft=!1),d||(d=!0,o.status=1,Ye("ready")),pr=!1,il=!1}o.redraw=(s,u)=>{xo=u||!1,s!==!1?An($,A.min,A.max):
Ao()};function Ri(s,u){let f=S[s];if(f.from==null){if(Je==0){let p=f.range(o,u.min,u.max,s);u.min=p[0],u.max=p[1]}if(u.min>
u.max){let p=u.min;u.min=u.max,u.max=p}if(Je>1&&u.min!=null&&u.max!=null&&u.max-u.min<1e-16)return;s==$&&f.distr==2&&Je>
0&&(u.min=Qt(u.min,t[0]),u.max=Qt(u.max,t[0]),u.min==u.max&&u.max++),U[s]=u,Si=!0,Ao()}}o.setScale=Ri;let Ii,Vi,Eo,No,Ba,
ja,Po,Oo,qa,Ya,be,Te,Tn=!1,Xe=V.drag,je=Xe.x,qe=Xe.y;ot&&(V.x&&(Ii=Vt(Rg,k)),V.y&&(Vi=Vt(Ig,k)),A.ori==0?(Eo=Ii,No=Vi):(Eo=
Vi,No=Ii),be=V.left,Te=V.top);let xe=o.select=Re({show:!0,over:!0,left:0,width:0,top:0,height:0},e.select),Fo=xe.show?Vt(
$g,xe.over?k:v):null;function sl(s,u){if(xe.show){for(let f in s)xe[f]=s[f],f in Ui&&Se(Fo,f,s[f]);u!==!1&&Ye("setSelect")}}
o.setSelect=sl;function Fd(s){if(w[s].show)Ie&&la(Ne[s],fo);else if(Ie&&At(Ne[s],fo),ot){let f=yo?Ct[0]:Ct[s];f!=null&&pn(
f,-10,-10,J,L)}}function An(s,u,f){Ri(s,{min:u,max:f})}function rn(s,u,f,p){u.focus!=null&&Rd(s),u.show!=null&&w.forEach(
(h,b)=>{b>0&&(s==b||s==null)&&(h.show=u.show,Fd(b),r==2?(An(h.facets[0].scale,null,null),An(h.facets[1].scale,null,null)):
An(h.scale,null,null),Ao())}),f!==!1&&Ye("setSeries",s,u),p&&vr("setSeries",o,s,u)}o.setSeries=rn;function Cd(s,u){Re(K[s],
u)}function Dd(s,u){s.fill=ne(s.fill||null),s.dir=se(s.dir,-1),u=u??K.length,K.splice(u,0,s)}function Ld(s){s==null?K.length=
0:K.splice(s,1)}o.addBand=Dd,o.setBand=Cd,o.delBand=Ld;function $d(s,u){w[s].alpha=u,ot&&Ct[s]!=null&&(Ct[s].style.opacity=
u),Ie&&Ne[s]&&(Ne[s].style.opacity=u)}let hn,En,qn,Co={focus:!0};function Rd(s){if(s!=qn){let u=s==null,f=on.alpha!=1;w.
forEach((p,h)=>{if(r==1||h>0){let b=u||h==0||h==s;p._focus=u?null:b,f&&$d(h,b?1:on.alpha)}}),qn=s,f&&Ao()}}Ie&&wo&&rt(Nf,
fe,s=>{V._lock||(Bn(s),qn!=null&&rn(null,Co,!0,Ce.setSeries))});function ln(s,u,f){let p=S[u];f&&(s=s/ce-(p.ori==1?Ve:_e));
let h=J;p.ori==1&&(h=L,s=h-s),p.dir==-1&&(s=h-s);let b=p._min,y=p._max,M=s/h,T=b+(y-b)*M,O=p.distr;return O==3?nr(10,T):
O==4?tv(T,p.asinh):O==100?p.bwd(T):T}function Id(s,u){let f=ln(s,$,u);return Qt(f,t[0],Ge,Be)}o.valToIdx=s=>Qt(s,t[0]),o.
posToIdx=Id,o.posToVal=ln,o.valToPos=(s,u,f)=>S[u].ori==0?l(s,S[u],f?pt:J,f?xt:0):a(s,S[u],f?Wt:L,f?Ot:0),o.setCursor=(s,u,f)=>{
be=s.left,Te=s.top,Yn(null,u,f)};function Ka(s,u){Se(Fo,Qo,xe.left=s),Se(Fo,jr,xe.width=u)}function Za(s,u){Se(Fo,"top",
xe.top=s),Se(Fo,qr,xe.height=u)}let mr=A.ori==0?Ka:Za,hr=A.ori==1?Ka:Za;function Vd(){if(Ie&&Q.live)for(let s=r==2?1:0;s<
w.length;s++){if(s==0&&Pt)continue;let u=Q.values[s],f=0;for(let p in u)tn[s][f++].firstChild.nodeValue=u[p]}}function zi(s,u){
if(s!=null&&(s.idxs?s.idxs.forEach((f,p)=>{de[p]=f}):lv(s.idx)||de.fill(s.idx),Q.idx=de[0]),Ie&&Q.live){for(let f=0;f<w.
length;f++)(f>0||r==1&&!Pt)&&zd(f,de[f]);Vd()}Ft=!1,u!==!1&&Ye("setLegend")}o.setLegend=zi;function zd(s,u){let f=w[s],p=s==
0&&B==2?Gt:t[s],h;Pt?h=f.values(o,s,u)??kn:(h=f.value(o,u==null?null:p[u],s,u),h=h==null?kn:{_:h}),Q.values[s]=h}function Yn(s,u,f){
qa=be,Ya=Te,[be,Te]=V.move(o,be,Te),V.left=be,V.top=Te,ot&&(Eo&&pn(Eo,Ue(be),0,J,L),No&&pn(No,0,Ue(Te),J,L));let p,h=Ge>
Be;hn=ge,En=null;let b=A.ori==0?J:L,y=A.ori==1?J:L;if(be<0||Je==0||h){p=V.idx=null;for(let M=0;M<w.length;M++){let T=Ct[M];
T!=null&&pn(T,-10,-10,J,L)}wo&&rn(null,Co,!0,s==null&&Ce.setSeries),Q.live&&(de.fill(p),Ft=!0)}else{let M,T,O;r==1&&(M=A.
ori==0?be:Te,T=ln(M,$),p=V.idx=Qt(T,t[0],Ge,Be),O=C(t[0][p],A,b,0));let D=-10,R=-10,Y=0,ae=0,ie=!0,ee="",j="";for(let z=r==
2?1:0;z<w.length;z++){let we=w[z],Pe=de[z],Ke=Pe==null?null:r==1?t[z][Pe]:t[z][1][Pe],me=V.dataIdx(o,z,p,T),Oe=me==null?
null:r==1?t[z][me]:t[z][1][me];if(Ft=Ft||Oe!=Ke||me!=Pe,de[z]=me,z>0&&we.show){let wt=me==null?-10:me==p?O:C(r==1?t[0][me]:
t[z][0][me],A,b,0),lt=Oe==null?-10:q(Oe,r==1?S[we.scale]:S[we.facets[1].scale],y,0);if(wo&&Oe!=null){let Dt=A.ori==1?be:
Te,Bt=We(on.dist(o,z,me,lt,Dt));if(Bt<hn){let sn=on.bias;if(sn!=0){let yt=ln(Dt,we.scale),Lt=Oe>=0?1:-1,jt=yt>=0?1:-1;jt==
Lt&&(jt==1?sn==1?Oe>=yt:Oe<=yt:sn==1?Oe<=yt:Oe>=yt)&&(hn=Bt,En=z)}else hn=Bt,En=z}}if(Ft||yo){let Dt,Bt;A.ori==0?(Dt=wt,
Bt=lt):(Dt=lt,Bt=wt);let sn,yt,Lt,jt,an,it,St=!0,Kn=tt.bbox;if(Kn!=null){St=!1;let st=Kn(o,z);Lt=st.left,jt=st.top,sn=st.
width,yt=st.height}else Lt=Dt,jt=Bt,sn=yt=tt.size(o,z);if(it=tt.fill(o,z),an=tt.stroke(o,z),yo)z==En&&hn<=on.prox&&(D=Lt,
R=jt,Y=sn,ae=yt,ie=St,ee=it,j=an);else{let st=Ct[z];st!=null&&(So[z]=Lt,ko[z]=jt,$f(st,sn,yt,St),Df(st,it,an),pn(st,zt(Lt),
zt(jt),J,L))}}}}if(yo){let z=on.prox,we=qn==null?hn<=z:hn>z||En!=qn;if(Ft||we){let Pe=Ct[0];Pe!=null&&(So[0]=D,ko[0]=R,$f(
Pe,Y,ae,ie),Df(Pe,ee,j),pn(Pe,zt(D),zt(R),J,L))}}}if(xe.show&&Tn)if(s!=null){let[M,T]=Ce.scales,[O,D]=Ce.match,[R,Y]=s.cursor.
sync.scales,ae=s.cursor.drag;if(je=ae._x,qe=ae._y,je||qe){let{left:ie,top:ee,width:j,height:z}=s.select,we=s.scales[R].ori,
Pe=s.posToVal,Ke,me,Oe,wt,lt,Dt=M!=null&&O(M,R),Bt=T!=null&&D(T,Y);Dt&&je?(we==0?(Ke=ie,me=j):(Ke=ee,me=z),Oe=S[M],wt=C(
Pe(Ke,R),Oe,b,0),lt=C(Pe(Ke+me,R),Oe,b,0),mr(en(wt,lt),We(lt-wt))):mr(0,b),Bt&&qe?(we==1?(Ke=ie,me=j):(Ke=ee,me=z),Oe=S[T],
wt=q(Pe(Ke,Y),Oe,y,0),lt=q(Pe(Ke+me,Y),Oe,y,0),hr(en(wt,lt),We(lt-wt))):hr(0,y)}else Wi()}else{let M=We(qa-Ba),T=We(Ya-ja);
if(A.ori==1){let Y=M;M=T,T=Y}je=Xe.x&&M>=Xe.dist,qe=Xe.y&&T>=Xe.dist;let O=Xe.uni;O!=null?je&&qe&&(je=M>=O,qe=T>=O,!je&&
!qe&&(T>M?qe=!0:je=!0)):Xe.x&&Xe.y&&(je||qe)&&(je=qe=!0);let D,R;je&&(A.ori==0?(D=Po,R=be):(D=Oo,R=Te),mr(en(D,R),We(R-D)),
qe||hr(0,y)),qe&&(A.ori==1?(D=Po,R=be):(D=Oo,R=Te),hr(en(D,R),We(R-D)),je||mr(0,b)),!je&&!qe&&(mr(0,0),hr(0,0))}if(Xe._x=
je,Xe._y=qe,s==null){if(f){if(su!=null){let[M,T]=Ce.scales;Ce.values[0]=M!=null?ln(A.ori==0?be:Te,M):null,Ce.values[1]=T!=
null?ln(A.ori==1?be:Te,T):null}vr(Js,o,be,Te,J,L,p)}if(wo){let M=f&&Ce.setSeries,T=on.prox;qn==null?hn<=T&&rn(En,Co,!0,M):
hn>T?rn(null,Co,!0,M):En!=qn&&rn(En,Co,!0,M)}}Ft&&(Q.idx=p,zi()),u!==!1&&Ye("setCursor")}let Nn=null;Object.defineProperty(
o,"rect",{get(){return Nn==null&&gr(!1),Nn}});function gr(s=!1){s?Nn=null:(Nn=k.getBoundingClientRect(),Ye("syncRect",Nn))}
function Ja(s,u,f,p,h,b,y){V._lock||Tn&&s!=null&&s.movementX==0&&s.movementY==0||(Hi(s,u,f,p,h,b,y,!1,s!=null),s!=null?Yn(
null,!0,!0):Yn(u,!0,!1))}function Hi(s,u,f,p,h,b,y,M,T){if(Nn==null&&gr(!1),Bn(s),s!=null)f=s.clientX-Nn.left,p=s.clientY-
Nn.top;else{if(f<0||p<0){be=-10,Te=-10;return}let[O,D]=Ce.scales,R=u.cursor.sync,[Y,ae]=R.values,[ie,ee]=R.scales,[j,z]=Ce.
match,we=u.axes[0].side%2==1,Pe=A.ori==0?J:L,Ke=A.ori==1?J:L,me=we?b:h,Oe=we?h:b,wt=we?p:f,lt=we?f:p;if(ie!=null?f=j(O,ie)?
c(Y,S[O],Pe,0):-10:f=Pe*(wt/me),ee!=null?p=z(D,ee)?c(ae,S[D],Ke,0):-10:p=Ke*(lt/Oe),A.ori==1){let Dt=f;f=p,p=Dt}}T&&(u==
null||u.cursor.event.type==Js)&&((f<=1||f>=J-1)&&(f=uo(f,J)),(p<=1||p>=L-1)&&(p=uo(p,L))),M?(Ba=f,ja=p,[Po,Oo]=V.move(o,
f,p)):(be=f,Te=p)}let Ui={width:0,height:0,left:0,top:0};function Wi(){sl(Ui,!1)}let Xa,Qa,eu,tu;function nu(s,u,f,p,h,b,y){
Tn=!0,je=qe=Xe._x=Xe._y=!1,Hi(s,u,f,p,h,b,y,!0,!1),s!=null&&(rt(Xs,oa,ou,!1),vr(Af,o,Po,Oo,J,L,null));let{left:M,top:T,width:O,
height:D}=xe;Xa=M,Qa=T,eu=O,tu=D}function ou(s,u,f,p,h,b,y){Tn=Xe._x=Xe._y=!1,Hi(s,u,f,p,h,b,y,!1,!0);let{left:M,top:T,width:O,
height:D}=xe,R=O>0||D>0,Y=Xa!=M||Qa!=T||eu!=O||tu!=D;if(R&&Y&&sl(xe),Xe.setScale&&R&&Y){let ae=M,ie=O,ee=T,j=D;if(A.ori==
1&&(ae=T,ie=D,ee=M,j=O),je&&An($,ln(ae,$),ln(ae+ie,$)),qe)for(let z in S){let we=S[z];z!=$&&we.from==null&&we.min!=ge&&An(
z,ln(ee+j,z),ln(ee,z))}Wi()}else V.lock&&(V._lock=!V._lock,Yn(u,!0,s!=null));s!=null&&(_o(Xs,oa),vr(Xs,o,be,Te,J,L,null))}
function Hd(s,u,f,p,h,b,y){if(V._lock)return;Bn(s);let M=Tn;if(Tn){let T=!0,O=!0,D=10,R,Y;A.ori==0?(R=je,Y=qe):(R=qe,Y=je),
R&&Y&&(T=be<=D||be>=J-D,O=Te<=D||Te>=L-D),R&&T&&(be=be<Po?0:J),Y&&O&&(Te=Te<Oo?0:L),Yn(null,!0,!0),Tn=!1}be=-10,Te=-10,de.
fill(null),Yn(null,!0,!0),M&&(Tn=M)}function ru(s,u,f,p,h,b,y){V._lock||(Bn(s),Mi(),Wi(),s!=null&&vr(Pf,o,be,Te,J,L,null))}
function lu(){P.forEach(w0),ki(o.width,o.height,!0)}po(ai,tr,lu);let Do={};Do.mousedown=nu,Do.mousemove=Ja,Do.mouseup=ou,
Do.dblclick=ru,Do.setSeries=(s,u,f,p)=>{let h=Ce.match[2];f=h(o,u,f),f!=-1&&rn(f,p,!0,!1)},ot&&(rt(Af,k,nu),rt(Js,k,Ja),
rt(Ef,k,s=>{Bn(s),gr(!1)}),rt(Nf,k,Hd),rt(Pf,k,ru),fa.add(o),o.syncRect=gr);let al=o.hooks=e.hooks||{};function Ye(s,u,f){
$i?dr.push([s,u,f]):s in al&&al[s].forEach(p=>{p.call(null,o,u,f)})}(e.plugins||[]).forEach(s=>{for(let u in s.hooks)al[u]=
(al[u]||[]).concat(s.hooks[u])});let iu=(s,u,f)=>f,Ce=Re({key:null,setSeries:!1,filters:{pub:Hf,sub:Hf},scales:[$,w[1]?w[1].
scale:null],match:[Uf,Uf,iu],values:[null,null]},V.sync);Ce.match.length==2&&Ce.match.push(iu),V.sync=Ce;let su=Ce.key,Gi=Ip(
su);function vr(s,u,f,p,h,b,y){Ce.filters.pub(s,u,f,p,h,b,y)&&Gi.pub(s,u,f,p,h,b,y)}Gi.sub(o);function Ud(s,u,f,p,h,b,y){
Ce.filters.sub(s,u,f,p,h,b,y)&&Do[s](null,u,f,p,h,b,y)}o.pub=Ud;function Wd(){Gi.unsub(o),fa.delete(o),zn.clear(),ia(ai,
tr,lu),m.remove(),fe?.remove(),Ye("destroy")}o.destroy=Wd;function Bi(){Ye("init",e,t),Ra(t||e.data,!1),U[$]?Ri($,U[$]):
Mi(),tl=xe.show&&(xe.width>0||xe.height>0),Gn=Ft=!0,ki(e.width,e.height)}return w.forEach(La),P.forEach(wd),n?n instanceof
HTMLElement?(n.appendChild(m),Bi()):n(o,Bi):Bi(),o}Ze.assign=Re;Ze.fmtNum=_a;Ze.rangeNum=ui;Ze.rangeLog=pi;Ze.rangeAsinh=
ga;Ze.orient=ho;Ze.pxRatio=ce;Ze.join=pv;Ze.fmtDate=xa,Ze.tzDate=Sv;Ze.sync=Ip;{Ze.addGap=l0,Ze.clipGaps=hi;let e=Ze.paths=
{points:Gp};e.linear=jp,e.stepped=a0,e.bars=u0,e.spline=f0}var y0=8;function Zp(e){let t=[...e.touches].map(r=>r.clientX),n=Math.min(...t),o=Math.max(...t);return{fingers:t.length,
middle:(n+o)/2,spread:o-n}}function Jp(e){let t=null;e.addEventListener("touchstart",n=>t=Zp(n),{passive:!0}),e.addEventListener(
"touchend",()=>t=null,{passive:!0}),e.addEventListener("touchmove",n=>{let o=Zp(n),{left:r,width:l}=e.getBoundingClientRect();
(!t||t.fingers!==o.fingers)&&(t=o),!(Math.abs(o.middle-t.middle)+Math.abs(o.spread-t.spread)<y0)&&(o.fingers>1&&o.spread>
0&&t.spread>0&&fn(t.spread/o.spread,(o.middle-r)/l),Gr((t.middle-o.middle)/l),t=o)},{passive:!0})}var nd=220,Xp=[[],[6,3],[2,2],[8,3,2,3]],bi=I(null),Aa=e=>String(e).padStart(2,"0");function S0(e,t){let n=new Date(e*1e3),
o=`${Aa(n.getHours())}:${Aa(n.getMinutes())}:${Aa(n.getSeconds())}`;return t?`${o}.${Math.floor(n.getMilliseconds()/100)}`:
o}var k0=(e,t,n,o,r)=>t.map(l=>S0(l,r<1));function Qp(e,t,n,o,r){let[l="",a="0"]=Number(r.toPrecision(3)).toExponential().
split("e"),c=Math.max(0,Math.min(9,l.replace(/\D/g,"").length-1-Number(a))),d=Math.max(...t.map(Math.abs));return t.map(
m=>d>=1e7?m.toExponential(2):m.toFixed(c))}var Na=e=>e.axis===1,M0=56,Xr=new Map;function ed(e,t,n){for(let r of Xr.keys())
r.root.isConnected||Xr.delete(r);let o=Xr.get(e)??[];return o[n]=Math.max(0,...(t??[]).map(r=>7*r.length+12)),Xr.set(e,o),
Math.max(M0,...[...Xr.values()].flat())}function T0(e,t){let n=lo("dim"),o={stroke:lo("line"),width:1},l={stroke:n,font:"\
11px system-ui, sans-serif",ticks:{...o,size:4},grid:o};return[{...l,values:k0,space:70,size:28},{...l,scale:"0",values:Qp,
size:ed,space:32},{...l,scale:"1",values:t?Qp:()=>[],ticks:{...l.ticks,show:t},size:ed,space:32,side:1,show:e,grid:{show:!1}}]}
function td(e,t,n){if(t===null||n===null||!Number.isFinite(t)||!Number.isFinite(n))return[0,1];let o=(n-t)*.08||Math.abs(
n)*.1||1;return[t-o,n+o]}function A0(e){return e.map((t,n)=>({label:t.formula,scale:String(t.axis),stroke:lo(`series-${n%
Yo}`),width:1.5,dash:Xp[Math.floor(n/2)%Xp.length],points:{size:4}}))}function E0(e,t){return{width:t,height:nd,legend:{
show:!1},padding:[8,24,0,0],cursor:{sync:{key:"time"},drag:{x:!0,y:!1,setScale:!1},focus:{prox:-1}},scales:{x:{time:!0,auto:!1},
0:{range:td},1:{range:td}},axes:T0(he.value.flat().some(Na),e.some(Na)),series:[{},...A0(e)],hooks:{setSelect:[N0],setCursor:[
P0]}}}function N0(e){let{left:t,width:n}=e.select;n<4||(so({from:e.posToVal(t,"x"),to:e.posToVal(t+n,"x")}),e.setSelect(
{left:0,top:0,width:0,height:0},!1))}function P0(e){let{left:t}=e.cursor;bi.value=t==null||t<0?null:e.posToVal(t,"x")}var O0=(e,{
scale:t,offset:n})=>Array.from(e,o=>Number.isFinite(o)?o*t+n:null);function F0(e,t){let n=Jt(),o=e.map(r=>{let[l,a]=bf(ao(
r,n),t);return[l,O0(a,r)]});return o.length===1?o[0]:Ze.join(o,o.map(r=>r.map(()=>1)))}function Ea(e,t){let{from:n,to:o}=Jt();
e.batch(()=>{e.setData(F0(t,e.width),!1),e.setScale("x",{min:n,max:o})})}function C0(e,t){e.preventDefault();let{left:n,
width:o}=t.over.getBoundingClientRect();fn(e.deltaY>0?1.25:.8,(e.clientX-n)/o)}function D0(e,t){let n=new Ze(E0(t,e.clientWidth),
[[],...t.map(()=>[])],e);n.over.addEventListener("wheel",r=>C0(r,n),{passive:!1}),Jp(n.over);let o=new ResizeObserver(()=>{
n.setSize({width:e.clientWidth,height:nd})});return o.observe(e),{chart:n,destroy:()=>{o.disconnect(),n.destroy()}}}function L0(e){
let t=setInterval(()=>{!document.hidden&&It.value===null&&e()},250);return()=>clearInterval(t)}function od({plot:e,onChart:t}){
let n=$t(null),o=$t(null),r=JSON.stringify([e,he.value.flat().some(Na)]);return Qe(()=>{if(!n.current)return;let l=D0(n.
current,e);o.current=l.chart,t(l.chart),Ea(l.chart,e);let a=L0(()=>Ea(l.chart,e));return()=>{a(),l.destroy(),o.current=null,
t(null)}},[r,xs.value]),Qe(()=>{o.current&&Ea(o.current,e)},[Zt.value,It.value]),i("div",{class:"chart",ref:n,role:"img",
"aria-label":`Plot of ${e.map(l=>l.formula).join(", ")}`})}function rd(e,t){return(()=>{if(t.value===null&&It.value===null)
return cn(e)?.points.latest??NaN;let{from:o,to:r}=Jt(),l=t.value??r,[a,c]=ao(e,{from:o,to:r}),d=NaN;for(let m=0;m<a.length&&
a[m]<=l;++m)d=c[m];return d})()*e.scale+e.offset}function $0(e,t,n){he.value=he.value.flatMap((o,r)=>{if(r!==e)return[o];let l=o.flatMap((a,c)=>c!==t?[a]:n?[{...a,...n}]:
[]);return l.length>0?[l]:[]})}function yi(e,t){let n=e.dataTransfer?.getData(Vs);if(!n)return;e.preventDefault();let{topic:o,
formula:r}=JSON.parse(n);Dr(jo(String(o),String(r)),t)}var Sn=I(""),Ht=I(""),xi=I("new"),R0=mt(()=>(qt.value,[...at.values()].
filter(e=>e.schema).map(e=>e.topic).sort())),wi=mt(()=>(qt.value,Ht.value===""?null:mf(Ht.value,Sn.value,e=>at.get(e)?.schema))),
Pa=mt(()=>df(Ht.value,Sn.value));function I0(e){e.preventDefault(),!(Pa.value===""||Ht.value===""||wi.value)&&(Dr(jo(Pa.
value,Ht.value),xi.value==="new"?null:Number(xi.value)),Ht.value="")}function id({text:e,found:t,id:n}){return t?i("p",{
class:"fault",role:"alert",id:n,children:[i("code",{children:[e.slice(0,t.at),i("mark",{children:e.slice(t.at,t.at+1)||"\
 "}),e.slice(t.at+1)]}),i("span",{children:["at ",t.at+1,": ",t.message]})]}):null}var Oa=e=>t=>{e.value=t.currentTarget.
value};function sd(){Sn.value===""&&Ht.value===""&&(Sn.value=ye.value??"")}var V0=()=>i("label",{children:["Topic",i("in\
put",{id:"topic",list:"topics",class:"mono",placeholder:"/1/1/VFR_HUD",value:Sn.value,autocomplete:"off",spellcheck:!1,onFocus:sd,
onInput:Oa(Sn)}),i("datalist",{id:"topics",children:R0.value.slice(0,500).map(e=>i("option",{value:e},e))})]}),z0=()=>i(
"label",{class:"grow",children:["Formula",i("input",{id:"formula",class:"mono",placeholder:"sqrt(vx^2 + vy^2) / 100",value:Ht.
value,autocomplete:"off",spellcheck:!1,"aria-invalid":wi.value!==null,"aria-describedby":"fault",title:"Fields of anothe\
r topic have its name before them: /2/1/VFR_HUD.alt",onFocus:sd,onInput:Oa(Ht)})]}),H0=()=>i("label",{children:["Into",i(
"select",{value:xi.value,onChange:Oa(xi),children:[i("option",{value:"new",children:"a new plot"}),he.value.map((e,t)=>i(
"option",{value:t,children:["plot ",t+1]},t))]})]});function U0(){let e=Sn.value!==""&&!at.has(Sn.value);return i("form",
{class:"formula",onSubmit:I0,children:[i(V0,{}),i(z0,{}),i(H0,{}),i("button",{type:"submit",disabled:Pa.value===""||Ht.value===
""||wi.value!==null,children:"Plot"}),e&&Ht.value!==""&&i("p",{class:"fault warning",children:["No ",Sn.value," has come\
 yet: the plot waits for it."]}),i(id,{text:Ht.value,found:wi.value,id:"fault"})]})}function W0(){Zt.value;let e=It.value!==
null;return i("div",{class:"toolbar",children:[i("button",{"aria-pressed":e,onClick:()=>e?Wr():so(),title:"Stop or follo\
w (space)",children:[i(ue,{name:e?"play":"pause"}),e?"Follow":"Pause"]}),i("label",{children:["Last"," ",i("select",{value:Ln.
value,onChange:t=>{Ln.value=Number(t.currentTarget.value),Wr()},children:gs.map(t=>i("option",{value:t,children:t<60?`${t}\
 s`:`${t/60} min`},t))})]}),i("span",{class:"group",children:[i("button",{onClick:()=>fn(.5),"aria-label":"Zoom in",title:"\
Zoom in (+)",children:"+"}),i("button",{onClick:()=>fn(2),"aria-label":"Zoom out",title:"Zoom out (\u2212)",children:"\u2212"})]}),
i("span",{class:"summary dim number",children:e&&`stands still \xB7 ${ut(_f())} new points`})]})}function G0(e){let[,t]=ao(
e,Jt()),n=1/0,o=-1/0;for(let l of t)l<n&&(n=l),l>o&&(o=l);let r=[n*e.scale+e.offset,o*e.scale+e.offset];return[Math.min(
...r),Math.max(...r)]}function ld({label:e,value:t,onValue:n}){return i("input",{type:"number",step:"any","aria-label":e,
title:e,value:t,onChange:o=>{n(Number(o.currentTarget.value)||(e==="Scale"?1:0))}})}function B0({series:e}){Zt.value;let t=cn(
e),n=t!==void 0&&t.total===0;if(t?.fault||n)return i("td",{class:t?.fault?"error":"dim",colSpan:4,children:t?.fault?"wro\
ng formula":"waits for its first message"});let[o,r]=G0(e);return i(te,{children:[i("td",{class:"number mono strong",children:qo(
rd(e,bi))}),i("td",{class:"dim",children:e.scale===1?t?.unit:""}),i("td",{class:"number mono dim",children:qo(o)}),i("td",
{class:"number mono dim",children:qo(r)})]})}function j0({series:e,set:t}){let n=e.axis===1,o=`Axis of ${e.formula}: ${n?
"right":"left"}`;return i(te,{children:[i("td",{children:i("button",{class:"axis","aria-label":o,title:o,onClick:()=>t({
axis:n?0:1}),children:n?"right":"left"})}),i("td",{children:i(ld,{label:"Scale",value:e.scale,onValue:r=>t({scale:r})})}),
i("td",{children:i(ld,{label:"Offset",value:e.offset,onValue:r=>t({offset:r})})}),i("td",{children:i("button",{class:"qu\
iet","aria-label":`Remove ${e.formula}`,title:"Remove",onClick:()=>t(null),children:i(ue,{name:"close"})})})]})}function q0({
series:e,at:t,index:n}){let o=cn(e)?.fault??null,r=i("tr",{children:[i("td",{children:i("i",{class:`swatch s${n%Yo} d${Math.
floor(n/2)%4}`})}),i("th",{scope:"row",class:"mono",children:i("span",{class:"cut",title:`${e.formula} of ${e.topic}`,children:[
e.formula," ",!e.formula.includes(e.topic)&&i("span",{class:"dim",children:e.topic})]})}),i(B0,{series:e}),i(j0,{series:e,
set:l=>$0(t,n,l)})]});return o?i(te,{children:[r,i("tr",{class:"wrong",children:[i("td",{}),i("td",{colSpan:9,children:i(
id,{text:e.formula,found:o})})]})]}):r}function Y0({plot:e,at:t}){return Zt.value,i("table",{class:"legend",children:[i(
"caption",{class:"hidden",children:["Series of plot ",t+1]}),i("thead",{children:i("tr",{children:[i("td",{}),i("th",{scope:"\
col",children:"Series"}),i("th",{scope:"col",class:"number",children:bi.value===null?"Latest":"Pointer"}),i("td",{}),i("\
th",{scope:"col",class:"number",children:"Least"}),i("th",{scope:"col",class:"number",children:"Most"}),i("th",{scope:"c\
ol",children:"Axis"}),i("th",{scope:"col",children:"Scale"}),i("th",{scope:"col",children:"Offset"}),i("td",{})]})}),i("\
tbody",{children:e.map((n,o)=>i(q0,{series:n,at:t,index:o},xn(n)))})]})}function K0({at:e,plot:t,savePicture:n}){let o=()=>{
he.value=he.value.filter((r,l)=>l!==e)};return i("header",{children:[i("h3",{children:["Plot ",e+1]}),i("span",{class:"g\
roup end",children:[i("button",{onClick:()=>yf(t),title:"Save what is shown as CSV",children:"CSV"}),i("button",{onClick:n,
title:"Save the picture",children:"PNG"}),i("button",{class:"quiet",onClick:o,"aria-label":`Remove plot ${e+1}`,title:"R\
emove the plot",children:i(ue,{name:"close"})})]})]})}function Z0({plot:e,at:t}){let n=$t(null),o=l=>{n.current=l},r=()=>{
n.current&&Sf(n.current.ctx.canvas,e)};return i("section",{class:"panel plot","aria-label":`Plot ${t+1}`,onDragOver:l=>l.
preventDefault(),onDrop:l=>yi(l,t),children:[i(K0,{at:t,plot:e,savePicture:r}),i(od,{plot:e,onChart:o}),i(Y0,{plot:e,at:t})]})}
function J0(){return i("div",{class:"empty start",children:[i(ue,{name:"plot"}),i("p",{children:["Open a message under ",
i("b",{children:"Messages"})," and click a number, or type a formula above."]})]})}var X0={" ":()=>It.value?Wr():so(),"+":()=>fn(
.5),"=":()=>fn(.5),"-":()=>fn(2),ArrowLeft:()=>Gr(-.25),ArrowRight:()=>Gr(.25),0:Wr,a:()=>Rn("#formula")};function ad(){
Ro(()=>Ul(X0),[]),gt.value;let e=ye.value!==null;return i(te,{children:[i("h2",{class:"hidden",children:"Plots"}),i("div",
{class:"list",onDragOver:t=>t.preventDefault(),onDrop:t=>{t.defaultPrevented||yi(t,null)},children:[i(W0,{}),i(U0,{}),i(
"div",{class:"scroller",tabIndex:-1,children:he.value.length===0?i(J0,{}):he.value.map((t,n)=>i(Z0,{plot:t,at:n},n))})]}),
e&&i(Jl,{hz:null})]})}var ud={overview:"Overview",messages:"Messages",plots:"Plots"},cd=e=>`#${Rl({...bs(),view:e})}`,fd=I(!1);Le(()=>{ht.value&&
(fd.value=!0)});Le(()=>{Nr.value!==""&&Bo(Nr.value)});var ur=mt(()=>ht.value?"live":fd.value?"lost":"connecting"),Q0=mt(
()=>Wo.value.filter(e=>e.ended_us===null&&e.severity!=="info"));function Fa({to:e}){let t=e!=="plots"?{}:{onDragOver:n=>n.
preventDefault(),onDrop:n=>yi(n,null)};return i("a",{href:cd(e),"aria-current":He.value===e?"page":void 0,...t,children:ud[e]})}
function e_(){let e=Q0.value,t=e.some(n=>n.severity==="error")?"error":"warning";return e.length===0?null:i("a",{class:`\
badge ${t}`,href:cd("overview"),children:[i(ue,{name:t}),e.length,i("span",{class:"wide",children:[" ",e.length===1?"ala\
rm":"alarms"]})]})}function t_(){let e={live:"live",lost:"lost",connecting:"opening"}[ur.value];return i("span",{class:`\
badge ${ur.value}`,title:Er.value,children:[i(ue,{name:ur.value}),e]})}function n_(){if(ur.value!=="lost")return null;gt.
value;let e=Ho.value===null?0:Math.max(0,Math.ceil((Ho.value-Date.now())/1e3));return i("div",{class:"banner",children:[
i(ue,{name:"lost"}),i("span",{children:[i("strong",{children:"Connection lost"})," ",Yt((Date.now()-(Tr.value??Date.now()))/
1e3)," ago. Values are old. ",e>0?`Next attempt in ${e} s.`:"Connecting\u2026"]}),i("button",{onClick:Pr,children:"Try n\
ow"})]})}function o_(){return i("header",{children:[i("h1",{children:"mavloom"}),i("nav",{"aria-label":"Views",children:[
i(Fa,{to:"overview"}),i(Fa,{to:"messages"}),i(Fa,{to:"plots"})]}),i("div",{class:"right",children:[i(e_,{}),i(t_,{}),i("\
button",{class:"quiet",onClick:zl,title:`Colours: ${$n.value} (t)`,"aria-label":`Colours: ${$n.value}`,children:i(ue,{name:$n.
value})}),i("button",{class:"quiet",onClick:()=>{Mt.value=!0},title:"Keys and licences (?)","aria-label":"Help",children:i(
ue,{name:"help"})})]})]})}var r_={overview:ff,messages:Wc,plots:ad};function pd(){Qe(()=>no.use(),[]),Qe(()=>{document.title=
`${ud[He.value]} \xB7 Mavloom`},[He.value]);let e=r_[He.value];return i("div",{class:`app ${ur.value}`,children:[i(o_,{}),
i(n_,{}),i("main",{class:He.value,children:i(e,{})}),i("div",{class:"notice",role:"status",hidden:Cr.value==="",children:Cr.
value}),i("div",{class:"hidden",role:"status",children:ur.value==="lost"?"The connection is lost":""}),i(yc,{})]})}cc();Mc();hf();Pr();Qu();addEventListener("keydown",xc);var dd=document.getElementById("app");dd&&wu(i(pd,{}),dd);})();
